import package::lib::ray::{Ray, ray_depth_m};
import package::lib::ray_state::{RayState};
import package::lib::slab_cells::{SLABS_PER_WORD, SLAB_SQUARE, STACK_ROWS, first_stack, slab_squares};
import package::lib::view::{view};

// Leaves what rays pass in slabs of depth, `view.pair.count` of them, even in k / depth: `Recorder` of `core::reference::slabs`.

// As of `lib/slab_cells`.
@group(2) @binding(8) var<storage, read_write> slab_cells: array<atomic<u32>>;

// The slab before the first visible sample.
const NO_SLAB: u32 = 0xffffffffu;

// Steps of a channel of a cell.
const CELL_STEPS: f32 = 255.0;

// The slab that a ray is in.
struct OpenSlab {
    // What the ray had gathered before it.
    color: vec3f,
    transmittance: f32,
    slab: u32,
}

var<private> slabs_pixel: vec2u;
var<private> open_slab: OpenSlab;
// What rounding down has left of the cells so far, steps.
var<private> lost_steps: vec4f;
var<private> filled_slabs: vec2u;

fn begin_recording(pixel: vec2u) {
    slabs_pixel = pixel;
    open_slab = OpenSlab(vec3f(0.0), 1.0, NO_SLAB);
    lost_steps = vec4f(0.5);
    filled_slabs = vec2u(0u);
}

// Adds sample i, between two states of its ray.
fn record(ray: Ray, i: u32, before: RayState, after: RayState) {
    let behind = view.pair.offset - view.pair.k / ray_depth_m(ray, f32(i));
    let slab = min(u32(max(behind, 0.0)), view.pair.count - 1u);
    let begins = after.transmittance < before.transmittance && slab != open_slab.slab;
    // A loop and no branch: software Vulkan would write for every sample.
    var is_left = begins && open_slab.slab != NO_SLAB;
    while is_left {
        end_slab(before);
        is_left = false;
    }
    if begins {
        open_slab = OpenSlab(before.color, before.transmittance, slab);
    }
}

fn end_recording(state: RayState) {
    if open_slab.slab != NO_SLAB {
        let color = end_slab(state);
        if state.is_finished == 1u {
            hide_behind(open_slab.slab, color.rgb / color.a);
        }
        let squares = slab_squares(vec2u(view.width, view.height));
        let square = slabs_pixel / SLAB_SQUARE;
        let at = 2u * (square.y * squares.x + square.x);
        atomicOr(&slab_cells[at], filled_slabs.x);
        atomicOr(&slab_cells[at + 1u], filled_slabs.y);
    }
}

// Where the cell of a slab is.
fn slab_cell_at(slab: u32) -> u32 {
    let stack = first_stack(vec2u(view.width, view.height), slab, slabs_pixel.y / STACK_ROWS) + slabs_pixel.x;
    return stack * STACK_ROWS + slabs_pixel.y % STACK_ROWS;
}

fn note_filled(slab: u32) {
    let bit = 1u << (slab % SLABS_PER_WORD);
    filled_slabs |= select(vec2u(bit, 0u), vec2u(0u, bit), slab >= SLABS_PER_WORD);
}

// Writes the cell of the slab that a ray is in, which has gathered what it has in all, behind what an earlier part of the ray has left
// there, and returns what this part has in it.
fn end_slab(state: RayState) -> vec4f {
    let color = vec4f(state.color - open_slab.color, open_slab.transmittance - state.transmittance) / open_slab.transmittance;
    let at = slab_cell_at(open_slab.slab);
    let held = unpack4x8unorm(atomicLoad(&slab_cells[at]));
    let exact = CELL_STEPS * (held + (1.0 - held.a) * color) + lost_steps;
    var steps = clamp(floor(exact), vec4f(0.0), vec4f(CELL_STEPS));
    // Nothing may look like a cell behind an end.
    steps = select(steps, vec4f(0.0), steps.a == 0.0);
    lost_steps = exact - steps;
    atomicStore(&slab_cells[at], pack4x8unorm(steps / CELL_STEPS));
    note_filled(open_slab.slab);
    return color;
}

// A cell behind what has a colour in a slab: `core::lightfield::anchors::Hider`.
fn hidden_cell(slab: u32, rgb: vec3f) -> u32 {
    let steps = vec3u(clamp(rgb, vec3f(0.0), vec3f(1.0)) * 63.0 + 0.5);
    return ((slab + 1u) << 18u) | (steps.b << 12u) | (steps.g << 6u) | steps.r;
}

// Marks what is behind a slab as unknown, if something of a colour hides it.
fn hide_behind(slab: u32, rgb: vec3f) {
    let cell = hidden_cell(slab, rgb);
    for (var hidden = slab + 1u; hidden < view.pair.count; hidden++) {
        atomicStore(&slab_cells[slab_cell_at(hidden)], cell);
        note_filled(hidden);
    }
}

// Pictures of surfaces have no slabs.
fn record_surface(depth_m: f32) {}
