import package::lib::lut_1d::{lut_at};
import package::lib::ray_state::{RayState};

// Segments are added up, in any order.

// Integral of the values, and 1 where a ray is in the visible box.
fn joint_of(segment: RayState) -> vec4f {
    return vec4f(segment.scalar, 0.0, 0.0, 1.0);
}

fn join(front: vec4f, back: vec4f) -> vec4f {
    return vec4f(front.rgb + back.rgb, max(front.a, back.a));
}

fn is_full(joint: vec4f) -> bool {
    return false;
}

fn color_of(joint: vec4f) -> vec4f {
    return vec4f(lut_at(min(joint.r, 1.0)).rgb, 1.0) * joint.a;
}
