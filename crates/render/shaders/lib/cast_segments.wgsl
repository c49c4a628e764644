import package::lib::cast_parameters::{parameters};
import package::lib::classify::{VALUE_OFFSET, may_be_visible};
import package::lib::composite::{SEARCHES, blend};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, RayState, STRETCH};
import package::lib::segment_sink::{SegmentPlace, put_segment};
import package::lib::segmented_ray::{SegmentedRay, is_spent, leaps, stretches};
import package::lib::skip::{next_run, start_walk};
import package::lib::slabs::{end_of_slab, slab_at};
import package::lib::view::{view};
import package::lib::volume::{value_at};

// Rays of the reference view cut into segments, one for each slab of depth: all samples of a slab land on the same derived
// column. `depth_m` of a segment is that of its first sample.

// A ray with a segment behind what it holds.
fn append(before: RayState, segment: RayState) -> RayState {
    var state = before;
    state.color += segment.color * state.transmittance;
    state.transmittance *= segment.transmittance;
    if state.depth_m == NOTHING_HIT && state.transmittance <= 1.0 - FIRST_HIT_ALPHA {
        state.depth_m = segment.depth_m;
    }
    return state;
}

// Casts a ray from where it is and hands each slab's segment over, until it is behind a slab, finished, or the invocation is
// spent. `place` is what the sink knows the ray by.
fn cast_segments(ray: Ray, furthest: i32, place: SegmentPlace, before: SegmentedRay) -> SegmentedRay {
    let end = end_of_slab(ray, furthest);
    let walk = start_walk(ray.first, ray.step);
    var state = before.state;
    var segment = before.segment;
    var slab = before.slab;
    var slab_end = select(end_of_slab(ray, slab), 0u, slab > view.pair.nearest);
    var run_end = 0u;
    var i = before.next;
    while i < end && state.is_finished == 0u && !is_spent() {
        stretches++;
        if i >= run_end {
            let run = next_run(walk, i, end, 0.0);
            state.map_reads += run.map_reads;
            leaps += run.map_reads;
            if VALUE_OFFSET != 0.0 && run.begin != i {
                segment.scalar = value_at(ray_at(ray, f32(run.begin) + VALUE_OFFSET - 1.0));
            }
            i = run.begin;
            run_end = run.end;
        }
        let stretch_begin = i;
        let stretch_end = min(i + STRETCH, run_end);
        while i < stretch_end {
            while i >= slab_end {
                if segment.transmittance < 1.0 {
                    put_segment(place, slab, segment);
                    state = append(state, segment);
                    segment.color = vec3f(0.0);
                    segment.transmittance = 1.0;
                }
                segment.depth_m = ray_depth_m(ray, f32(i));
                // A ray has one segment in each slab, however the bounds are rounded.
                slab = min(slab_at(segment.depth_m), slab - 1);
                slab_end = max(end_of_slab(ray, slab), i + 1u);
            }
            var value = 0.0;
            var is_found = false;
            loop {
                value = value_at(ray_at(ray, f32(i) + VALUE_OFFSET));
                is_found = may_be_visible(value, segment.scalar);
                if is_found || !SEARCHES || i + 1u >= min(stretch_end, slab_end) {
                    break;
                }
                segment.scalar = value;
                i++;
            }
            if is_found {
                segment = blend(ray, i, value, segment);
            }
            segment.scalar = value;
            i++;
            if state.transmittance * segment.transmittance <= 1.0 - parameters.termination_alpha {
                state.is_finished = 1u;
                break;
            }
        }
        state.samples += i - stretch_begin;
    }
    state.is_finished |= select(0u, 1u, i >= ray.sample_count);
    if (state.is_finished == 1u || i >= end) && segment.transmittance < 1.0 {
        put_segment(place, slab, segment);
        state = append(state, segment);
        segment.color = vec3f(0.0);
        segment.transmittance = 1.0;
    }
    return SegmentedRay(i, slab, state, segment);
}
