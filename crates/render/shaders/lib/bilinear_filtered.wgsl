import package::lib::warp::{color_sampler, color_source, warp};

// Colour at a position in pixels from the top left, bilinear; transparent from one pixel outside of the outermost middles, up to
// which the sampler goes on with the picture's edge.
fn color_about(position: vec2f) -> vec4f {
    let counts = clamp(min(position, warp.size - position) + 0.5, vec2f(0.0), vec2f(1.0));
    return textureSampleLevel(color_source, color_sampler, position * warp.pixel, 0.0) * counts.x * counts.y;
}
