import package::lib::warp::{color_at};

// Colour at a position in pixels from the top left, bilinear; transparent from one pixel outside of the outermost middles.
fn color_about(position: vec2f) -> vec4f {
    let at = position - 0.5;
    let first = floor(at);
    let along = at - first;
    let above = mix(color_at(first), color_at(first + vec2f(1.0, 0.0)), along.x);
    let below = mix(color_at(first + vec2f(0.0, 1.0)), color_at(first + vec2f(1.0, 1.0)), along.x);
    return mix(above, below, along.y);
}
