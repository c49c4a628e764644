import package::lib::cover_picture::{cover_picture};
import package::lib::grid_surface::{meeting_of, ray_through};
import package::lib::warp::{color_at, warp};

// The picture as a surface of its first hits: colours.
@fragment
fn warp_grid(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let h = warp.matrix * vec3f(position.xy, 1.0);
    if h.z <= 0.0 {
        return vec4f(0.0);
    }
    let met = meeting_of(ray_through(h));
    let color = met.shares.x * color_at(met.first)
        + met.shares.y * color_at(met.first + vec2f(1.0, 0.0))
        + met.shares.z * color_at(met.first + vec2f(0.0, 1.0))
        + met.shares.w * color_at(met.first + vec2f(1.0, 1.0));
    return color * select(0.0, 1.0, met.is_any);
}
