import package::lib::shear::{anchor_column, shear};
import package::lib::slab_cells::{CLEAR_CELL, SLAB_SQUARE, SLABS_PER_WORD, STACK_ROWS, stack_of_cells};

// The picture of a view out of the slabs of its nearest anchor: `core::lightfield::anchors::derive`. A workgroup is a square, an
// invocation four rows of a column.

// What passes a ray where it ends.
const LEAST_THROUGH: f32 = 0.01;

// Planes of the anchor, as of `lib/slab_cells`, a stack at a time.
@group(0) @binding(1) var<storage, read> slab_stacks: array<vec4u>;
// Premultiplied RGBA.
@group(0) @binding(2) var color_target: texture_storage_2d<rgba32float, write>;
// Slabs of squares, counted from the first that is derived: bits in two words.
@group(0) @binding(3) var<storage, read> listed: array<vec2u>;

// Four cells, clear beyond the sides of the picture.
fn cells_at(first: u32, column: i32) -> vec4u {
    let inside = clamp(column, 0, i32(shear.anchor_size.x) - 1);
    return select(vec4u(CLEAR_CELL), slab_stacks[first + u32(inside)], column == inside);
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
    while any(left_slabs != vec2u(0u)) && any(through >= vec4f(LEAST_THROUGH)) {
        let is_in_second = left_slabs.x == 0u;
        let word = select(left_slabs.x, left_slabs.y, is_in_second);
        let slab = firstTrailingBit(word) + select(0u, SLABS_PER_WORD, is_in_second);
        let rest = word & (word - 1u);
        left_slabs = select(vec2u(rest, left_slabs.y), vec2u(0u, rest), is_in_second);
        let at = anchor_column(pixel.x, slab);
        let left = floor(at);
        let share = u32((at - left) * 256.0 + 0.5);
        let first = stack_of_cells(shear.anchor_size, slab, stack_row);
        let near = cells_at(first, i32(left));
        let next = cells_at(first, i32(left) + 1);
        let weight = select(vec4f(0.0), through, through >= vec4f(LEAST_THROUGH));
        let red_blue = two_between(near, next, share);
        let green_alpha = two_between(near >> vec4u(8u), next >> vec4u(8u), share);
        r += weight * lower_of(red_blue);
        g += weight * lower_of(green_alpha);
        b += weight * upper_of(red_blue);
        through -= weight * upper_of(green_alpha);
    }
    for (var row = 0u; row < STACK_ROWS; row++) {
        if pixel.y + row < shear.size.y {
            textureStore(color_target, pixel + vec2u(0u, row), vec4f(r[row], g[row], b[row], 1.0 - through[row]));
        }
    }
}
