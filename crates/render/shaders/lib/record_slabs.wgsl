import package::lib::ray::{Ray, ray_depth_m};
import package::lib::ray_state::{RayState};
import package::lib::slab_cells::{HIDER_SHIFT, HIDER_STEPS, SLAB_SQUARE, STACK_ROWS, slab_bit, slab_squares, stack_of_cells, stack_of_ends, words_of_bits};
import package::lib::view::{view};

// Leaves what rays pass in slabs of depth, `view.pair.count` of them, even in k / depth: `Recorder` of `core::reference::slabs`.

// As of `lib/slab_cells`.
@group(2) @binding(8) var<storage, read_write> slab_cells: array<atomic<u32>>;

// The slab before the first visible sample.
const NO_SLAB: u32 = 0xffffffffu;

// Behind every sample.
const NO_END: f32 = 4e9;

// Steps of a channel of a cell.
const CELL_STEPS: f32 = 255.0;

// The slab that a ray is in.
struct OpenSlab {
    // What the ray had gathered before it.
    color: vec3f,
    transmittance: f32,
    slab: u32,
    // The first sample behind it.
    end_sample: f32,
}

var<private> slabs_pixel: vec2u;
var<private> open_slab: OpenSlab;
// What rounding down has left of the cells so far, steps.
var<private> lost_steps: vec4f;
var<private> filled_slabs: vec2u;
// Whether the slab that the ray is in, or comes to, is the first of this part of it.
var<private> is_first_slab: bool;

fn begin_recording(pixel: vec2u) {
    slabs_pixel = pixel;
    open_slab = OpenSlab(vec3f(0.0), 1.0, NO_SLAB, -1.0);
    lost_steps = vec4f(0.5);
    filled_slabs = vec2u(0u);
    is_first_slab = true;
}

// Begins samples from i on, of a ray in a state, and returns the first one that is in another slab.
fn begin_stretch(ray: Ray, i: u32, state: RayState) -> u32 {
    // A loop and no branch: software Vulkan would end slabs at every stretch.
    var is_left = f32(i) >= open_slab.end_sample;
    while is_left {
        if state.transmittance < open_slab.transmittance {
            end_slab(state);
        }
        let behind = view.pair.offset - view.pair.k / ray_depth_m(ray, f32(i));
        let slab = min(u32(max(behind, 0.0)), view.pair.count - 1u);
        open_slab = OpenSlab(state.color, state.transmittance, slab, max(end_sample(ray, slab), f32(i + 1u)));
        is_left = false;
    }
    return u32(open_slab.end_sample);
}

fn record(ray: Ray, i: u32, before: RayState, after: RayState) {}

// The first sample behind a slab.
fn end_sample(ray: Ray, slab: u32) -> f32 {
    let per_k = view.pair.offset - f32(slab + 1u);
    let is_last = per_k <= 0.0 || slab + 1u >= view.pair.count || ray.step_depth_m <= 0.0;
    let sample = (view.pair.k / per_k - ray.first_depth_m) / ray.step_depth_m;
    return select(min(ceil(sample), NO_END), NO_END, is_last);
}

fn end_recording(state: RayState) {
    if state.transmittance < open_slab.transmittance {
        let color = end_slab(state);
        if state.is_finished == 1u {
            let end = stack_of_ends(vec2u(view.width, view.height), slabs_pixel.y / STACK_ROWS);
            atomicStore(&slab_cells[word_of(end)], hider(open_slab.slab, color.rgb / color.a));
        }
    }
    if any(filled_slabs != vec2u(0u)) {
        let squares = slab_squares(vec2u(view.width, view.height));
        let square = slabs_pixel / SLAB_SQUARE;
        let at = 2u * (square.y * squares.x + square.x);
        atomicOr(&slab_cells[at], filled_slabs.x);
        atomicOr(&slab_cells[at + 1u], filled_slabs.y);
    }
}

// Where the word of the ray's pixel is, of a row of stacks.
fn word_of(first_stack: u32) -> u32 {
    return words_of_bits(vec2u(view.width, view.height)) + (first_stack + slabs_pixel.x) * STACK_ROWS + slabs_pixel.y % STACK_ROWS;
}

// Writes the cell of the slab that a ray is in, if it is in one, which has gathered what it has in all, and returns what this part has in it.
fn end_slab(state: RayState) -> vec4f {
    let gathered = vec4f(state.color - open_slab.color, open_slab.transmittance - state.transmittance);
    let color = gathered * (1.0 / open_slab.transmittance);
    let at = word_of(stack_of_cells(vec2u(view.width, view.height), open_slab.slab, slabs_pixel.y / STACK_ROWS));
    // What an earlier part of the ray has left in the slab.
    var held = vec4f(0.0);
    var may_be_held = is_first_slab && open_slab.slab != NO_SLAB;
    while may_be_held {
        held = unpack4x8unorm(atomicLoad(&slab_cells[at]));
        is_first_slab = false;
        may_be_held = false;
    }
    let exact = CELL_STEPS * (held + (1.0 - held.a) * color) + lost_steps;
    let steps = clamp(floor(exact), vec4f(0.0), vec4f(CELL_STEPS));
    lost_steps = exact - steps;
    let bytes = vec4u(steps) << vec4u(0u, 8u, 16u, 24u);
    if open_slab.slab != NO_SLAB {
        atomicStore(&slab_cells[at], bytes.x | bytes.y | bytes.z | bytes.w);
        filled_slabs |= slab_bit(open_slab.slab);
    }
    return color;
}

// What has a colour in a slab, and hides what is behind.
fn hider(slab: u32, rgb: vec3f) -> u32 {
    let steps = vec3u(clamp(rgb, vec3f(0.0), vec3f(1.0)) * HIDER_STEPS + 0.5);
    return ((slab + 1u) << HIDER_SHIFT) | (steps.b << 12u) | (steps.g << 6u) | steps.r;
}

// Pictures of surfaces have no slabs.
fn record_surface(depth_m: f32) {}
