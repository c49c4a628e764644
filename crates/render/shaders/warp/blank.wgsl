import package::lib::cover_picture::{cover_picture};

// Nothing.
@fragment
fn warp_blank() -> @location(0) vec4f {
    return vec4f(0.0);
}
