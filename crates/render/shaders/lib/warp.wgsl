// Mirror of `warp::flat_uniform::WarpUniform`.

struct Warp {
    // Pixels of the wanted view, infinitely far away (of a quad: on its plane), to homogeneous pixels of the shown one; z is 1 / depth there.
    matrix: mat3x3f,
    // Homogeneous pixel of the wanted eye in the shown picture, per metre.
    epipole: vec3f,
    // Largest inverse depth that there may be in the shown picture, 1/m.
    nearest: f32,
    // Width and height of the shown picture, pixels.
    size: vec2f,
    // Width and height of one of its pixels in parts of the picture.
    pixel: vec2f,
    // Least depth that the wanted view shows, metres.
    near_m: f32,
    // How far apart neighbours may move before the surface is torn between them, pixels.
    tear_px: f32,
    // Widest hole that is closed, pixels.
    close_px: f32,
}

@group(0) @binding(0) var<uniform> warp: Warp;
// Of the shown picture: premultiplied colour.
@group(0) @binding(1) var color_source: texture_2d<f32>;
// Depth of the first hit in metres; 0, or more than any other, without one.
@group(0) @binding(2) var depth_source: texture_2d<f32>;
// Interpolates colours, if the device does.
@group(0) @binding(3) var color_sampler: sampler;
@group(0) @binding(4) var nearest_texel: sampler;

// Colour of a pixel; transparent outside of the picture.
fn color_at(pixel: vec2f) -> vec4f {
    let is_inside = all(pixel >= vec2f(0.0)) && all(pixel < warp.size);
    let nearest = vec2i(clamp(pixel, vec2f(0.0), warp.size - 1.0));
    return textureLoad(color_source, nearest, 0) * select(0.0, 1.0, is_inside);
}
