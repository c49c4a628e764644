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
}

@group(0) @binding(1) var<uniform> view: View;
