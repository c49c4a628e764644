import package::lib::shear::{anchor_column, shear, slab_stacks};
import package::lib::slab_cells::{CLEAR_CELL, LEAST_KNOWN_CELL, SLAB_SQUARE, SLABS_PER_WORD, STACK_ROWS, first_stack};
import package::lib::unknown::{LEAST_THROUGH, LEAST_UNKNOWN, Unknown};

// The picture of a view out of the slabs of its nearest anchor, and where that knows no more: the first pass of
// `core::lightfield::anchors::derive`. A workgroup is a square, an invocation four rows of a column.

@group(0) @binding(2) var<storage, read_write> unknown: array<Unknown>;
// Premultiplied RGBA.
@group(0) @binding(3) var color_target: texture_storage_2d<rgba32float, write>;
// Slabs of squares, counted from the first that is derived: bits in two words.
@group(0) @binding(4) var<storage, read> listed: array<vec2u>;

// Four cells, clear beyond the sides of the picture.
fn cells_at(first: u32, column: i32) -> vec4u {
    let inside = clamp(column, 0, i32(shear.anchor_size.x) - 1);
    return select(vec4u(CLEAR_CELL), slab_stacks[first + u32(inside)], column == inside);
}

// Whether rays have ended before cells.
fn are_hidden(cells: vec4u) -> vec4<bool> {
    return (cells != vec4u(CLEAR_CELL)) & (cells < vec4u(LEAST_KNOWN_CELL));
}

// Two channels of cells, 16 bits apart.
const TWO_CHANNELS: u32 = 0xff00ffu;

// Red and blue of cells between two columns, or green and opacity of cells moved by eight bits, with eight bits behind the point each:
// half the work of one channel at a time.
fn two_between(near: vec4u, next: vec4u, share: u32) -> vec4u {
    let left = near & vec4u(TWO_CHANNELS);
    let right = next & vec4u(TWO_CHANNELS);
    return left * (256u - share) + right * share;
}

// The lower one of two channels, from 0 to 1.
fn lower_of(two: vec4u) -> vec4f {
    return vec4f(two & vec4u(0xffffu)) * (1.0 / 65280.0);
}

// The upper one.
fn upper_of(two: vec4u) -> vec4f {
    return vec4f(two >> vec4u(16u)) * (1.0 / 65280.0);
}

@compute @workgroup_size(8, 2)
fn derive(@builtin(workgroup_id) square: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let pixel = (shear.first_square + square.xy) * SLAB_SQUARE + local.xy * vec2u(1u, STACK_ROWS);
    if any(pixel >= shear.size) {
        return;
    }
    let stack_row = pixel.y / STACK_ROWS;
    var left_slabs = listed[square.y * shear.squares.x + square.x];
    var r = vec4f(0.0);
    var g = vec4f(0.0);
    var b = vec4f(0.0);
    var through = vec4f(1.0);
    // Rays that have come to what the anchor does not see: how much of them, and the slab.
    var guessed = vec4f(0.0);
    var guessed_from = vec4u(0u);
    while any(left_slabs != vec2u(0u)) && any(through >= vec4f(LEAST_THROUGH)) {
        let is_in_second = left_slabs.x == 0u;
        let word = select(left_slabs.x, left_slabs.y, is_in_second);
        let slab = firstTrailingBit(word) + select(0u, SLABS_PER_WORD, is_in_second);
        let rest = word & (word - 1u);
        left_slabs = select(vec2u(rest, left_slabs.y), vec2u(0u, rest), is_in_second);
        let at = anchor_column(pixel.x, slab);
        let left = floor(at);
        let share = u32((at - left) * 256.0 + 0.5);
        let first = first_stack(shear.anchor_size, slab, stack_row);
        let held = cells_at(first, i32(left));
        let held_next = cells_at(first, i32(left) + 1);
        // Between what is hidden and what is not, there is what is not: what hides the one has been there before.
        let near_is_hidden = are_hidden(held);
        let next_is_hidden = are_hidden(held_next);
        let is_unknown = near_is_hidden & next_is_hidden;
        let near = select(select(held, held_next, near_is_hidden), vec4u(CLEAR_CELL), is_unknown);
        let next = select(select(held_next, held, next_is_hidden), vec4u(CLEAR_CELL), is_unknown);
        let weight = select(vec4f(0.0), through, through >= vec4f(LEAST_THROUGH));
        let red_blue = two_between(near, next, share);
        let green_alpha = two_between(near >> vec4u(8u), next >> vec4u(8u), share);
        r += weight * lower_of(red_blue);
        g += weight * lower_of(green_alpha);
        b += weight * upper_of(red_blue);
        let ends = is_unknown & (weight > vec4f(0.0));
        guessed = select(guessed, through, ends);
        guessed_from = select(guessed_from, vec4u(slab), ends);
        through = select(through - weight * upper_of(green_alpha), vec4f(0.0), ends);
    }
    // What is guessed takes the colour of the rest; of rays of which it is much, the next pass makes another one.
    let is_kept = guessed <= vec4f(LEAST_UNKNOWN);
    let scale = select(vec4f(1.0), 1.0 / (1.0 - guessed), is_kept);
    for (var row = 0u; row < STACK_ROWS; row++) {
        if pixel.y + row < shear.size.y {
            let color = vec4f(scale[row] * vec3f(r[row], g[row], b[row]), 1.0 - through[row]);
            textureStore(color_target, pixel + vec2u(0u, row), color);
        }
    }
    let at_unknown = stack_row * shear.size.x + pixel.x;
    unknown[at_unknown].through = guessed;
    // A loop and no branch: software Vulkan would write for every ray.
    var is_left = !all(is_kept);
    while is_left {
        unknown[at_unknown].first_slab = guessed_from;
        unknown[at_unknown].r = r;
        unknown[at_unknown].g = g;
        unknown[at_unknown].b = b;
        is_left = false;
    }
}
