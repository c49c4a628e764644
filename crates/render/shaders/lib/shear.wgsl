import package::lib::slab_cells::{SLABS_PER_WORD, SLAB_SQUARE, slab_squares};

// Mirror of `anchors::ShearUniform`: how a view comes of an anchor.
struct Shear {
    // Width and height of the view, pixels.
    size: vec2u,
    // Width and height of the anchor's picture.
    anchor_size: vec2u,
    // The first square of pixels that is derived, and how many along x and y.
    first_square: vec2u,
    squares: vec2u,
    // From a column of the view to that at which the anchor sees the nearest slab, and from slab to slab, pixels.
    offset_px: f32,
    per_slab_px: f32,
    slab_count: u32,
}

@group(0) @binding(0) var<uniform> shear: Shear;
// The anchor's slabs, as of `lib/slab_cells`, a stack at a time.
@group(0) @binding(1) var<storage, read> slab_stacks: array<vec4u>;

// The column of the anchor's picture at which it sees a column in a slab; whole numbers are middles of pixels.
fn anchor_column(column: u32, slab: u32) -> f32 {
    return f32(column) + shear.offset_px + f32(slab) * shear.per_slab_px;
}

// A word of the bits of a square of the anchor's picture.
fn bits_at(square: i32, word: u32) -> u32 {
    let at = 2u * u32(square) + word;
    return slab_stacks[at / 4u][at % 4u];
}

// Bits of the slabs in which a square of the view may have something.
fn slabs_of_square(square: vec2u) -> vec2u {
    let columns = i32(slab_squares(shear.anchor_size).x);
    let first = i32(square.y) * columns;
    var slabs = vec2u(0u);
    for (var slab = 0u; slab < shear.slab_count; slab++) {
        let left = i32(floor(anchor_column(square.x * SLAB_SQUARE, slab)));
        let bit = 1u << (slab % SLABS_PER_WORD);
        let word = slab / SLABS_PER_WORD;
        // Eight columns, and the one after.
        let begin = left >> 3u;
        let end = (left + i32(SLAB_SQUARE)) >> 3u;
        var held = 0u;
        if begin >= 0 && begin < columns {
            held = bits_at(first + begin, word);
        }
        if end >= 0 && end < columns {
            held |= bits_at(first + end, word);
        }
        slabs[word] |= held & bit;
    }
    return slabs;
}
