import package::lib::cover_picture::{cover_picture};
import package::lib::grid_surface::{meeting_of, ray_through};
import package::lib::warp::{warp};

// The picture as a surface of its first hits: near depth over depth, of the wanted view; 0 is infinitely far.
@fragment
fn warp_grid_depth(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let h = warp.matrix * vec3f(position.xy, 1.0);
    if h.z <= 0.0 {
        return vec4f(0.0);
    }
    let met = meeting_of(ray_through(h));
    let inverse_depth = met.inverse_depth * h.z / (1.0 - met.inverse_depth * warp.epipole.z);
    return vec4f(clamp(warp.near_m * inverse_depth, 0.0, 1.0) * select(0.0, 1.0, met.is_any));
}
