import package::lib::accumulate::{accumulate};
import package::lib::cast_parameters::{parameters};
import package::lib::join::{joint_of};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::ray_state::{STRETCH, new_ray_state};
import package::lib::segment_sink::{SegmentPlace, put_segment};
import package::lib::segmented_ray::{SegmentedRay, is_spent, leaps, stretches};
import package::lib::slabs::{bounds_of_slab_m, end_of_slab, slab_at, start_of_slab};

// Rays of the reference view whose values are added up, cut into segments as in `cast_segments`. There is one for each slab that
// a ray passes through in the visible box, whether it has samples there or not: pixels are opaque where a ray was.

fn cast_segments(ray: Ray, furthest: i32, place: SegmentPlace, before: SegmentedRay) -> SegmentedRay {
    let last = max(furthest, slab_at(ray_depth_m(ray, f32(ray.sample_count) - 0.5)));
    var slab = min(before.slab - 1, slab_at(ray_depth_m(ray, -0.5)));
    var state = before.state;
    while slab >= last && ray.sample_count > 0u && !is_spent() {
        let depth_m = max(ray.first_depth_m, bounds_of_slab_m(slab).x);
        let begin = start_of_slab(ray, slab);
        var segment = accumulate(ray, begin, end_of_slab(ray, slab), new_ray_state(0.0, depth_m));
        state.scalar += segment.scalar;
        state.samples += segment.samples;
        state.map_reads += segment.map_reads;
        stretches += 1u + segment.samples / STRETCH;
        leaps += segment.map_reads;
        segment.scalar *= ray.step_length * parameters.xray_scale;
        put_segment(place, slab, joint_of(segment), segment.depth_m);
        slab--;
    }
    state.is_finished |= select(0u, 1u, slab < last && furthest <= last);
    return SegmentedRay(0u, slab + 1, 0u, 0.0, vec4f(0.0), state, state);
}
