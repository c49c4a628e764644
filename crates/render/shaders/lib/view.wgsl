import package::lib::pair::{Pair};

// Mirror of `uniforms::ViewUniform`: the rays of a view, affine in the pixel coordinates, in texture space.

struct View {
    // Origin at the picture's top left corner.
    origin: vec3f,
    // Nearest depth along view -Z, metres.
    near_m: f32,
    // Change of the origin per pixel to the right.
    origin_dx: vec3f,
    // Furthest depth along view -Z, metres.
    far_m: f32,
    // Change of the origin per pixel down.
    origin_dy: vec3f,
    // Width in pixels.
    width: u32,
    // Direction at the picture's top left corner, per metre of depth.
    direction: vec3f,
    // Height in pixels.
    height: u32,
    // Change of the direction per pixel to the right.
    direction_dx: vec3f,
    // First row of the piece that is cast.
    first_row: u32,
    // Change of the direction per pixel down.
    direction_dy: vec3f,
    // Rows of the piece that is cast.
    row_count: u32,
    // First sample of each ray to take.
    first_sample: u32,
    // Samples of each ray to take at most.
    sample_limit: u32,
    // Step between the bands of rows that neighbouring workgroups take; has no common factor with the band count.
    band_stride: u32,
    // First column of the piece that is cast.
    first_column: u32,
    // Where the rays of the picture's left edge are shaded from, homogeneous: a point (w = 1) or a vector that points there (w = 0).
    viewpoint: vec4f,
    // Change of that per pixel to the right.
    viewpoint_dx: vec4f,
    // What the view has in common with the one that is derived from its rays; zeros where none is.
    //
    // Not in a buffer of its own: Mesa 22's software Vulkan crashes on branches and loops that depend on a uniform buffer after
    // the third, and is slower where they depend on a storage buffer.
    pair: Pair,
}

// Rows of a band: the side of the square of pixels that a workgroup takes; `BAND_ROWS` of the host.
const BAND_ROWS: u32 = 8u;

@group(0) @binding(1) var<uniform> view: View;

// The first pixel of the 8 x 8 that a workgroup takes.
fn first_pixel_of_group(group: vec3u) -> vec2u {
    let band_count = (view.row_count + BAND_ROWS - 1u) / BAND_ROWS;
    let band = (group.y * view.band_stride) % band_count;
    return vec2u(view.first_column, view.first_row) + vec2u(group.x, band) * BAND_ROWS;
}

fn is_outside_piece(pixel: vec2u) -> bool {
    return pixel.x >= view.width || pixel.y >= view.first_row + view.row_count;
}
