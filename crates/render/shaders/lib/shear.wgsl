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

// The column of the anchor's picture at which it sees a column in a slab; whole numbers are middles of pixels.
fn anchor_column(column: u32, slab: u32) -> f32 {
    return f32(column) + shear.offset_px + f32(slab) * shear.per_slab_px;
}
