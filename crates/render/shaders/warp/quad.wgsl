import package::lib::bilinear::{color_about};
import package::lib::cover_picture::{cover_picture};
import package::lib::warp::{warp};

// The picture on a plane (VR 5.3.1), which the matrix is that of.
@fragment
fn warp_quad(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let h = warp.matrix * vec3f(position.xy, 1.0);
    return color_about(h.xy / h.z) * select(0.0, 1.0, h.z > 0.0);
}
