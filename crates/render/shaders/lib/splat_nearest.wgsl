import package::lib::join::{joint_of};
import package::lib::ray::{Ray};
import package::lib::segmented_ray::{SegmentedRay};

// A segment contributes to the derived column that is nearest to its slab (SP).

// Premultiplied RGBA for the derived column of the segment's slab and for the next one.
struct Splat {
    here: vec4f,
    next: vec4f,
}

fn splat(ray: Ray, under_way: SegmentedRay) -> Splat {
    return Splat(joint_of(under_way.segment), vec4f(0.0));
}
