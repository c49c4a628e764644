// Mirror of `first_hits::PassageUniform`: `core::first_hits::Passage`.

// Slabs that the depths of a view are cut into.
const SLABS: u32 = 8u;

struct Passage {
    // Homogeneous coordinates in the last picture (column w, row w, w, depth) at depth 0: at the top left, and their change per pixel to
    // the right and down.
    origin: mat3x4f,
    // Their change per metre of depth, alike.
    direction: mat3x4f,
    // Bounds of the slabs from near to far, metres, four in each vector.
    slab_depths_m: array<vec4f, 3>,
    // Width and height of the last picture, pixels; 0 where there is none.
    last_size: vec2f,
    // Nearest and furthest depth that it shows, metres.
    last_range_m: vec2f,
    // Width and height of the picture, pixels.
    size: vec2u,
    // The first tile whose rays are cast.
    first_tile: vec2u,
    // How much nearer something may be than what was seen, metres.
    margin_m: f32,
}
