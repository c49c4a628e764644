import package::lib::join::{joint_of};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::segmented_ray::{SegmentedRay};
import package::lib::slabs::{fraction_of_slab};

// A segment contributes to the two derived columns around where its samples land in the mean, by how near that is to each. In
// the next column the segment of the ray before is in front of it: a surface's colour there is interpolated between both, and
// what passes both is what passes each of them alone, so that what is opaque stays opaque.

// Premultiplied RGBA for the derived column of the segment's slab and for the next one.
struct Splat {
    here: vec4f,
    next: vec4f,
}

// Opacity in front that leaves something for what is behind.
const MOST_ALPHA: f32 = 1.0 - 1.0 / 16777216.0;

fn splat(ray: Ray, under_way: SegmentedRay) -> Splat {
    let joint = joint_of(under_way.segment);
    let share = fraction_of_slab(under_way.slab, ray_depth_m(ray, under_way.moment / joint.a));
    let here = joint * (1.0 - share);
    return Splat(here, joint * (share / (1.0 - min(here.a, MOST_ALPHA))));
}
