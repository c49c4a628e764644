import package::lib::cover_picture::{cover_picture};
import package::lib::warp::{color_at, warp};

// The picture on a plane (VR 5.3.1), which the matrix is that of.
@fragment
fn warp_quad(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let h = warp.matrix * vec3f(position.xy, 1.0);
    let at = h.xy / h.z - 0.5;
    let first = floor(at);
    let along = at - first;
    let above = mix(color_at(first), color_at(first + vec2f(1.0, 0.0)), along.x);
    let below = mix(color_at(first + vec2f(0.0, 1.0)), color_at(first + vec2f(1.0, 1.0)), along.x);
    return mix(above, below, along.y) * select(0.0, 1.0, h.z > 0.0);
}
