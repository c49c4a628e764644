import package::lib::accumulate::{accumulate, start_ray};
import package::lib::cast_parameters::{parameters};
import package::lib::pair::{pair};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::ray_state::{RayState, new_ray_state};
import package::lib::segment_sink::{SegmentPlace, put_segment};
import package::lib::slabs::{bounds_of_slab_m, end_of_slab, slab_at, start_of_slab};

// Rays of the reference view whose values are added up, cut into segments as in `cast_segments`. There is one for each slab that
// a ray passes through in the visible box, whether it has samples there or not: pixels are opaque where a ray was.

fn cast_segments(ray: Ray, place: SegmentPlace) -> RayState {
    return cast_slabs(ray, pair.nearest, pair.furthest, start_ray(ray), place);
}

fn cast_slabs(ray: Ray, nearest: i32, furthest: i32, before: RayState, place: SegmentPlace) -> RayState {
    let last = max(furthest, slab_at(ray_depth_m(ray, f32(ray.sample_count) - 0.5)));
    var slab = min(nearest, slab_at(ray_depth_m(ray, -0.5)));
    var state = before;
    while slab >= last && ray.sample_count > 0u {
        let depth_m = max(ray.first_depth_m, bounds_of_slab_m(slab).x);
        let begin = start_of_slab(ray, slab);
        var segment = accumulate(ray, begin, end_of_slab(ray, slab), new_ray_state(0.0, depth_m));
        state.scalar += segment.scalar;
        state.samples += segment.samples;
        state.map_reads += segment.map_reads;
        segment.scalar *= ray.step_length * parameters.xray_scale;
        put_segment(place, slab, segment);
        slab--;
    }
    return state;
}
