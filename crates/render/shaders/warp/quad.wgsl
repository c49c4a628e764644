import package::lib::cover_picture::{cover_picture};
import package::lib::warp::{color_source, warp};

// The picture on a plane (VR 5.3.1), which the matrix is that of: bilinear, transparent outside of the picture.
@fragment
fn warp_quad(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let h = warp.matrix * vec3f(position.xy, 1.0);
    let at = h.xy / h.z - 0.5;
    let first = floor(at);
    let second = first + 1.0;
    let along = at - first;
    let last = warp.size - 1.0;
    let lo = clamp(first, vec2f(0.0), last);
    let hi = clamp(second, vec2f(0.0), last);
    // What is outside of the picture has been moved into it, and counts for nothing.
    let near = select(vec2f(0.0), 1.0 - along, lo == first);
    let far = select(vec2f(0.0), along, hi == second);
    let a = vec2i(lo);
    let b = vec2i(hi);
    let above = near.x * textureLoad(color_source, a, 0) + far.x * textureLoad(color_source, vec2i(b.x, a.y), 0);
    let below = near.x * textureLoad(color_source, vec2i(a.x, b.y), 0) + far.x * textureLoad(color_source, b, 0);
    return (near.y * above + far.y * below) * select(0.0, 1.0, h.z > 0.0);
}
