// Mirror of `warp::volumetric_uniform::LayeredWarpUniform`.

struct LayeredWarp {
    // Pixels of the wanted view to change of the homogeneous pixel of the shown one per metre of depth in the wanted view.
    matrix: mat3x3f,
    // Homogeneous pixel of the wanted eye in the shown picture, metres.
    epipole: vec3f,
    // Width of a shown pixel per metre of depth.
    pixel_tangent: f32,
    // Least and greatest depth that the wanted view shows, metres.
    wanted_m: vec2f,
    // Width and height of the shown picture, pixels.
    size: vec2f,
    // Rays of the wanted view: direction per metre of depth at the top left corner, and its change per pixel.
    wanted_direction: vec3f,
    // Most steps of a ray.
    most_steps: f32,
    wanted_dx: vec3f,
    wanted_dy: vec3f,
    // The same rays of the shown view.
    shown_direction: vec3f,
    shown_dx: vec3f,
    shown_dy: vec3f,
}

@group(0) @binding(0) var<uniform> warp: LayeredWarp;
// Of the shown picture: what its rays pass through, as `lib/layer_words`.
@group(0) @binding(1) var layers: texture_2d_array<u32>;
// Depths from and to of what is in each tile of it, metres, ...
@group(0) @binding(2) var tiles: texture_2d<f32>;
// and in all of it.
@group(0) @binding(3) var range: texture_2d<f32>;
