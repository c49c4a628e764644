import package::lib::cast_parameters::{parameters};
import package::lib::ray_state::{RayState};

// Segments are joined by `over`.

// Premultiplied RGBA.
fn joint_of(segment: RayState) -> vec4f {
    return vec4f(segment.color, 1.0 - segment.transmittance);
}

fn join(front: vec4f, back: vec4f) -> vec4f {
    return front + back * (1.0 - front.a);
}

// Whether nothing behind is seen.
fn is_full(joint: vec4f) -> bool {
    return joint.a >= parameters.termination_alpha;
}

fn color_of(joint: vec4f) -> vec4f {
    return joint;
}
