import package::lib::slab_cells::{CLEAR_CELL, HIDER_SHIFT, HIDER_STEPS, SLAB_SQUARE, STACK_ROWS, slab_bit, slab_squares, stack_of_cells, stack_of_ends};

// Fills what an anchor does not see by what the anchors next to it do: `core::lightfield::anchors::fill`. An invocation is four rows of a
// column. Only hidden cells are written, and of the anchors next to it only others are read.

// Mirror of `anchors::FillUniform`: how an anchor's picture comes of those next to it, at most two.
struct Fill {
    // Width and height of the picture, pixels.
    size: vec2u,
    // Widths of the anchors next to it, which are as high.
    widths: vec2u,
    // From a column of the picture to that at which each sees the nearest slab, and from slab to slab, pixels.
    offsets_px: vec2f,
    per_slab_px: vec2f,
    // How many there are.
    neighbour_count: u32,
    slab_count: u32,
}

@group(0) @binding(0) var<uniform> parameters: Fill;
// Bits of squares, as of `lib/slab_cells`.
@group(0) @binding(1) var<storage, read_write> own_bits: array<atomic<u32>>;
// Planes, a stack at a time.
@group(0) @binding(2) var<storage, read_write> own: array<vec4u>;
@group(0) @binding(3) var<storage, read> first_neighbour: array<vec4u>;
@group(0) @binding(4) var<storage, read> second_neighbour: array<vec4u>;

// How many slabs behind what hides a place, for all anchors, it still counts as that: `MOST_BEHIND` of the host.
const MOST_BEHIND: u32 = 2u;

// Cells of a stack, and what hides them or nothing.
struct Places {
    cells: vec4u,
    hiders: vec4u,
}

// What hides a slab, if that is behind ends.
fn hiders_of(ends: vec4u, slab: u32) -> vec4u {
    return select(vec4u(0u), ends, vec4u(slab + 1u) > (ends >> vec4u(HIDER_SHIFT)));
}

fn own_places(slab: u32, column: i32, stack_row: u32) -> Places {
    let inside = u32(clamp(column, 0, i32(parameters.size.x) - 1));
    let cells = own[stack_of_cells(parameters.size, slab, stack_row) + inside];
    let ends = own[stack_of_ends(parameters.size, stack_row) + inside];
    return places(cells, hiders_of(ends, slab), column == i32(inside));
}

fn places_of_first(slab: u32, column: i32, stack_row: u32) -> Places {
    let size = vec2u(parameters.widths.x, parameters.size.y);
    let inside = u32(clamp(column, 0, i32(size.x) - 1));
    let cells = first_neighbour[stack_of_cells(size, slab, stack_row) + inside];
    let ends = first_neighbour[stack_of_ends(size, stack_row) + inside];
    return places(cells, hiders_of(ends, slab), column == i32(inside));
}

fn places_of_second(slab: u32, column: i32, stack_row: u32) -> Places {
    let size = vec2u(parameters.widths.y, parameters.size.y);
    let inside = u32(clamp(column, 0, i32(size.x) - 1));
    let cells = second_neighbour[stack_of_cells(size, slab, stack_row) + inside];
    let ends = second_neighbour[stack_of_ends(size, stack_row) + inside];
    return places(cells, hiders_of(ends, slab), column == i32(inside));
}

// Clear beyond the sides of a picture.
fn places(cells: vec4u, hiders: vec4u, is_inside: bool) -> Places {
    return Places(select(vec4u(CLEAR_CELL), cells, is_inside), select(vec4u(0u), hiders, is_inside));
}

// What an anchor tells between two columns: cells, and the furthest of what hides those that it does not see.
fn between(left: Places, right: Places, share: f32) -> Places {
    let left_is_hidden = left.hiders != vec4u(0u);
    let right_is_hidden = right.hiders != vec4u(0u);
    // Between what is hidden and what is not, there is what is not: what hides the one has been there before.
    let near = select(left.cells, right.cells, left_is_hidden);
    let next = select(right.cells, left.cells, right_is_hidden);
    var cells = vec4u(CLEAR_CELL);
    for (var row = 0u; row < STACK_ROWS; row++) {
        cells[row] = pack4x8unorm(mix(unpack4x8unorm(near[row]), unpack4x8unorm(next[row]), share));
    }
    let furthest = max(left.hiders, right.hiders);
    return Places(cells, select(vec4u(0u), furthest, left_is_hidden & right_is_hidden));
}

// The opaque cells of what hides something.
fn hider_cells(hiders: vec4u) -> vec4u {
    let six_bits = vec4u(63u);
    let red = byte_of(hiders & six_bits);
    let green = byte_of((hiders >> vec4u(6u)) & six_bits);
    let blue = byte_of((hiders >> vec4u(12u)) & six_bits);
    return red | (green << vec4u(8u)) | (blue << vec4u(16u)) | vec4u(0xff000000u);
}

fn byte_of(steps: vec4u) -> vec4u {
    return vec4u(vec4f(steps) * (255.0 / HIDER_STEPS) + 0.5);
}

// What is put in places that nothing sees.
fn guess(slab: u32, column: i32, stack_row: u32, hiders: vec4u) -> vec4u {
    let left = own_places(slab, column - 1, stack_row);
    let right = own_places(slab, column + 1, stack_row);
    let is_left_clear = (left.hiders == vec4u(0u)) & (left.cells == vec4u(CLEAR_CELL));
    let is_right_clear = (right.hiders == vec4u(0u)) & (right.cells == vec4u(CLEAR_CELL));
    let is_just_behind = vec4u(slab + 1u) - (hiders >> vec4u(HIDER_SHIFT)) <= vec4u(MOST_BEHIND);
    let is_solid = is_just_behind | vec4<bool>(slab + 1u == parameters.slab_count);
    let is_at_edge = is_left_clear | is_right_clear;
    return select(vec4u(CLEAR_CELL), hider_cells(hiders), is_solid & !is_at_edge);
}

@compute @workgroup_size(8, 2)
fn fill(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.size.x || id.y * STACK_ROWS >= parameters.size.y {
        return;
    }
    let column = f32(id.x);
    let ends = own[stack_of_ends(parameters.size, id.y) + id.x];
    let no_slab = vec4u(parameters.slab_count);
    let first_hidden = select(ends >> vec4u(HIDER_SHIFT), no_slab, ends == vec4u(0u));
    let first = min(min(first_hidden.x, first_hidden.y), min(first_hidden.z, first_hidden.w));
    var filled = vec2u(0u);
    for (var slab = first; slab < parameters.slab_count; slab++) {
        let at = vec2f(column) + parameters.offsets_px + f32(slab) * parameters.per_slab_px;
        let left = vec2i(floor(at));
        let share = fract(at);
        let by_first = between(places_of_first(slab, left.x, id.y), places_of_first(slab, left.x + 1, id.y), share.x);
        let by_second = between(places_of_second(slab, left.y, id.y), places_of_second(slab, left.y + 1, id.y), share.y);
        let is_first = (by_first.hiders == vec4u(0u)) & vec4<bool>(parameters.neighbour_count > 0u);
        let is_second = (by_second.hiders == vec4u(0u)) & vec4<bool>(parameters.neighbour_count > 1u);
        let is_hidden = first_hidden <= vec4u(slab);
        var cells = select(by_second.cells, by_first.cells, is_first);
        var is_left = any(is_hidden & !is_first & !is_second);
        while is_left {
            let hiders = max(ends, max(by_first.hiders, by_second.hiders));
            cells = select(guess(slab, i32(id.x), id.y, hiders), cells, is_first | is_second);
            is_left = false;
        }
        let stack = stack_of_cells(parameters.size, slab, id.y) + id.x;
        let held = own[stack];
        own[stack] = select(held, cells, is_hidden);
        filled |= select(vec2u(0u), slab_bit(slab), any(is_hidden & (cells != vec4u(CLEAR_CELL))));
    }
    let square = vec2u(id.x, id.y * STACK_ROWS) / SLAB_SQUARE;
    let bits_at = 2u * (square.y * slab_squares(parameters.size).x + square.x);
    var is_left = any(filled != vec2u(0u));
    while is_left {
        atomicOr(&own_bits[bits_at], filled.x);
        atomicOr(&own_bits[bits_at + 1u], filled.y);
        is_left = false;
    }
}
