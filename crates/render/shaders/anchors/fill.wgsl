import package::lib::slab_cells::{CLEAR_CELL, HIDER_SHIFT, HIDER_STEPS, SLAB_SQUARE, STACK_ROWS, first_cell_at, first_end_at, slab_bit, slab_squares};

// Fills what an anchor does not see by what the anchors next to it do: `core::lightfield::anchors::fill`. An invocation is a pixel. Only
// hidden cells are written, and of the anchors next to it only others are read.

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
// Buffers as of `lib/slab_cells`.
@group(0) @binding(1) var<storage, read_write> own: array<atomic<u32>>;
@group(0) @binding(2) var<storage, read> first_neighbour: array<u32>;
@group(0) @binding(3) var<storage, read> second_neighbour: array<u32>;

// How many slabs behind what hides a place, for all anchors, it still counts as that: `MOST_BEHIND` of the host.
const MOST_BEHIND: u32 = 2u;

// A cell of an anchor, and what hides it or nothing.
struct Place {
    cell: u32,
    hider: u32,
}

// What an anchor tells of a place.
struct Seen {
    // Premultiplied RGBA.
    color: vec4f,
    // The furthest of what hides it; zero if it is seen.
    hider: u32,
}

// What hides a slab, if that is behind an end.
fn hider_of(end: u32, slab: u32) -> u32 {
    return select(0u, end, slab + 1u > (end >> HIDER_SHIFT));
}

fn own_place(slab: u32, column: i32, row: u32) -> Place {
    let inside = u32(clamp(column, 0, i32(parameters.size.x) - 1));
    let cell = atomicLoad(&own[first_cell_at(parameters.size, slab, row) + inside * STACK_ROWS]);
    let end = atomicLoad(&own[first_end_at(parameters.size, row) + inside * STACK_ROWS]);
    return place(cell, hider_of(end, slab), column == i32(inside));
}

fn first_place(slab: u32, column: i32, row: u32) -> Place {
    let size = vec2u(parameters.widths.x, parameters.size.y);
    let inside = u32(clamp(column, 0, i32(size.x) - 1));
    let cell = first_neighbour[first_cell_at(size, slab, row) + inside * STACK_ROWS];
    let end = first_neighbour[first_end_at(size, row) + inside * STACK_ROWS];
    return place(cell, hider_of(end, slab), column == i32(inside));
}

fn second_place(slab: u32, column: i32, row: u32) -> Place {
    let size = vec2u(parameters.widths.y, parameters.size.y);
    let inside = u32(clamp(column, 0, i32(size.x) - 1));
    let cell = second_neighbour[first_cell_at(size, slab, row) + inside * STACK_ROWS];
    let end = second_neighbour[first_end_at(size, row) + inside * STACK_ROWS];
    return place(cell, hider_of(end, slab), column == i32(inside));
}

// Clear beyond the sides of a picture.
fn place(cell: u32, hider: u32, is_inside: bool) -> Place {
    return Place(select(CLEAR_CELL, cell, is_inside), select(0u, hider, is_inside));
}

// Between two places.
fn seen(left: Place, right: Place, share: f32) -> Seen {
    // Between what is hidden and what is not, there is what is not: what hides the one has been there before.
    let near = unpack4x8unorm(select(left.cell, right.cell, left.hider != 0u));
    let next = unpack4x8unorm(select(right.cell, left.cell, right.hider != 0u));
    let is_hidden = left.hider != 0u && right.hider != 0u;
    return Seen(mix(near, next, share), select(0u, max(left.hider, right.hider), is_hidden));
}

// The colour of what hides something, opaque.
fn hider_color(hider: u32) -> vec4f {
    return vec4f(vec3f(vec3u(hider, hider >> 6u, hider >> 12u) & vec3u(63u)) / HIDER_STEPS, 1.0);
}

// What is put in a place that nothing sees.
fn guess(slab: u32, column: i32, row: u32, hider: u32) -> vec4f {
    let left = own_place(slab, column - 1, row);
    let right = own_place(slab, column + 1, row);
    let is_at_edge = (left.hider == 0u && left.cell == CLEAR_CELL) || (right.hider == 0u && right.cell == CLEAR_CELL);
    let is_solid = slab + 1u - (hider >> HIDER_SHIFT) <= MOST_BEHIND || slab + 1u == parameters.slab_count;
    return select(vec4f(0.0), hider_color(hider), is_solid && !is_at_edge);
}

@compute @workgroup_size(8, 8)
fn fill(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= parameters.size) {
        return;
    }
    let column = f32(id.x);
    let end = atomicLoad(&own[first_end_at(parameters.size, id.y) + id.x * STACK_ROWS]);
    var filled = vec2u(0u);
    for (var slab = select(end >> HIDER_SHIFT, parameters.slab_count, end == 0u); slab < parameters.slab_count; slab++) {
        let at = vec2f(column) + parameters.offsets_px + f32(slab) * parameters.per_slab_px;
        let left = vec2i(floor(at));
        let share = fract(at);
        let by_first = seen(first_place(slab, left.x, id.y), first_place(slab, left.x + 1, id.y), share.x);
        let by_second = seen(second_place(slab, left.y, id.y), second_place(slab, left.y + 1, id.y), share.y);
        let is_first = parameters.neighbour_count > 0u && by_first.hider == 0u;
        let is_second = parameters.neighbour_count > 1u && by_second.hider == 0u;
        var color = select(by_second.color, by_first.color, is_first);
        var is_left = !is_first && !is_second;
        while is_left {
            color = guess(slab, i32(id.x), id.y, max(end, max(by_first.hider, by_second.hider)));
            is_left = false;
        }
        let cell = pack4x8unorm(color);
        atomicStore(&own[first_cell_at(parameters.size, slab, id.y) + id.x * STACK_ROWS], cell);
        filled |= select(vec2u(0u), slab_bit(slab), cell != CLEAR_CELL);
    }
    let squares = slab_squares(parameters.size);
    let square = id.xy / SLAB_SQUARE;
    let bits_at = 2u * (square.y * squares.x + square.x);
    var is_left = any(filled != vec2u(0u));
    while is_left {
        atomicOr(&own[bits_at], filled.x);
        atomicOr(&own[bits_at + 1u], filled.y);
        is_left = false;
    }
}
