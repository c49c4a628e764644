import package::lib::shear::{Shear, shear, slab_stacks};
import package::lib::slab_cells::{CLEAR_CELL, LEAST_KNOWN_CELL, STACK_ROWS, first_stack};
import package::lib::unknown::{LEAST_THROUGH, LEAST_UNKNOWN, Unknown};

// Goes on with the rays of a view where its nearest anchor does not see on, by what another one sees: the second pass of
// `core::lightfield::anchors::derive`. An invocation is a pixel.

// How many slabs behind what hides a place, for both anchors, it still counts as that: `MOST_BEHIND` of the host.
const MOST_BEHIND: u32 = 2u;

// Bits below the slab of what hides a cell.
const HIDER_SHIFT: u32 = 18u;

@group(0) @binding(2) var<storage, read> unknown: array<Unknown>;
// Premultiplied RGBA.
@group(0) @binding(3) var color_target: texture_storage_2d<rgba32float, write>;
// The other anchor; the same one, if there is none.
@group(0) @binding(4) var<uniform> other: Shear;
@group(0) @binding(5) var<storage, read> other_stacks: array<vec4u>;

// What an anchor tells of a place.
struct Seen {
    // Premultiplied RGBA.
    color: vec4f,
    // The furthest of what hides it; clear if it is seen.
    hider: u32,
}

// A cell of the nearest anchor; clear beyond the sides of its picture.
fn nearest_cell(slab: u32, column: i32, row: u32) -> u32 {
    let inside = clamp(column, 0, i32(shear.anchor_size.x) - 1);
    let stack = first_stack(shear.anchor_size, slab, row / STACK_ROWS) + u32(inside);
    return select(CLEAR_CELL, slab_stacks[stack][row % STACK_ROWS], column == inside);
}

// A cell of the other anchor.
fn other_cell(slab: u32, column: i32, row: u32) -> u32 {
    let inside = clamp(column, 0, i32(other.anchor_size.x) - 1);
    let stack = first_stack(other.anchor_size, slab, row / STACK_ROWS) + u32(inside);
    return select(CLEAR_CELL, other_stacks[stack][row % STACK_ROWS], column == inside);
}

fn nearest_cells(slab: u32, column: f32, row: u32) -> vec2u {
    return vec2u(nearest_cell(slab, i32(floor(column)), row), nearest_cell(slab, i32(floor(column)) + 1, row));
}

fn other_cells(slab: u32, column: f32, row: u32) -> vec2u {
    return vec2u(other_cell(slab, i32(floor(column)), row), other_cell(slab, i32(floor(column)) + 1, row));
}

fn nearest_column(slab: u32, column: u32) -> f32 {
    return f32(column) + shear.offset_px + f32(slab) * shear.per_slab_px;
}

fn other_column(slab: u32, column: u32) -> f32 {
    return f32(column) + other.offset_px + f32(slab) * other.per_slab_px;
}

// What hides cells; clear where nothing does.
fn hiders(cells: vec2u) -> vec2u {
    return select(vec2u(CLEAR_CELL), cells, cells < vec2u(LEAST_KNOWN_CELL));
}

// Between two cells.
fn seen(cells: vec2u, column: f32) -> Seen {
    let hidden = hiders(cells);
    let is_hidden = hidden != vec2u(CLEAR_CELL);
    let near = unpack4x8unorm(select(cells.x, cells.y, is_hidden.x));
    let next = unpack4x8unorm(select(cells.y, cells.x, is_hidden.y));
    let hider = select(CLEAR_CELL, max(hidden.x, hidden.y), all(is_hidden));
    return Seen(mix(near, next, fract(column)), hider);
}

// The colour of what hides something, opaque.
fn hider_color(hider: u32) -> vec4f {
    return vec4f(vec3f(vec3u(hider, hider >> 6u, hider >> 12u) & vec3u(63u)) / 63.0, 1.0);
}

@compute @workgroup_size(8, 8)
fn ask_both(@builtin(global_invocation_id) id: vec3u) {
    let pixel = shear.first_square * 8u + id.xy;
    if any(pixel >= shear.size) {
        return;
    }
    let at_unknown = pixel.y / STACK_ROWS * shear.size.x + pixel.x;
    let in_stack = pixel.y % STACK_ROWS;
    if unknown[at_unknown].through[in_stack] <= LEAST_UNKNOWN {
        return;
    }
    let rgb = vec3f(unknown[at_unknown].r[in_stack], unknown[at_unknown].g[in_stack], unknown[at_unknown].b[in_stack]);
    var color = vec4f(rgb, 1.0 - unknown[at_unknown].through[in_stack]);
    var slab = unknown[at_unknown].first_slab[in_stack];
    // Something is hidden by what is in a slab before.
    var last_known = max(slab, 1u) - 1u;
    while slab < shear.slab_count && 1.0 - color.a >= LEAST_THROUGH {
        let column = nearest_column(slab, pixel.x);
        let of_nearest = seen(nearest_cells(slab, column, pixel.y), column);
        let column_of_other = other_column(slab, pixel.x);
        let of_other = seen(other_cells(slab, column_of_other, pixel.y), column_of_other);
        let is_nearest = of_nearest.hider == CLEAR_CELL;
        let is_known = is_nearest || of_other.hider == CLEAR_CELL;
        let hider = max(of_nearest.hider, of_other.hider);
        let is_just_behind = slab + 1u - (hider >> HIDER_SHIFT) <= MOST_BEHIND;
        let known = select(of_other.color, of_nearest.color, is_nearest);
        let behind = select(vec4f(0.0), hider_color(hider), is_just_behind);
        color += (1.0 - color.a) * select(behind, known, is_known);
        last_known = select(last_known, slab, is_known);
        slab++;
    }
    let last = shear.slab_count - 1u;
    if last_known < last && 1.0 - color.a >= LEAST_THROUGH {
        var furthest = hiders(nearest_cells(last, nearest_column(last_known, pixel.x), pixel.y));
        furthest = max(furthest, hiders(nearest_cells(last, nearest_column(last, pixel.x), pixel.y)));
        furthest = max(furthest, hiders(other_cells(last, other_column(last_known, pixel.x), pixel.y)));
        furthest = max(furthest, hiders(other_cells(last, other_column(last, pixel.x), pixel.y)));
        let hider = max(furthest.x, furthest.y);
        color += (1.0 - color.a) * select(vec4f(0.0), hider_color(hider), hider != CLEAR_CELL);
    }
    textureStore(color_target, pixel, color);
}
