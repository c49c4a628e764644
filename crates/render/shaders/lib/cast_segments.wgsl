import package::lib::cast_parameters::{parameters};
import package::lib::classify::{VALUE_OFFSET, may_be_visible};
import package::lib::composite::{SEARCHES, blend};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, RayState, STRETCH};
import package::lib::segment_sink::{SegmentPlace, put_segment};
import package::lib::segmented_ray::{SegmentedRay, is_spent, leaps, stretches};
import package::lib::shade::{SHADING_IS_DEAR};
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

// Hands the segment over that a ray has left behind.
fn leave_segment(place: SegmentPlace, before: SegmentedRay) -> SegmentedRay {
    var under_way = before;
    if under_way.segment.transmittance < 1.0 {
        put_segment(place, under_way.slab, under_way.segment);
        under_way.state = append(under_way.state, under_way.segment);
        under_way.segment.color = vec3f(0.0);
        under_way.segment.transmittance = 1.0;
    }
    return under_way;
}

// Leaves the segment, and begins that of the next sample's slab.
fn enter_slab(ray: Ray, place: SegmentPlace, before: SegmentedRay) -> SegmentedRay {
    var under_way = leave_segment(place, before);
    under_way.segment.depth_m = ray_depth_m(ray, f32(under_way.next));
    // A ray has one segment in each slab, however the bounds are rounded.
    under_way.slab = min(slab_at(under_way.segment.depth_m), under_way.slab - 1);
    under_way.slab_end = max(end_of_slab(ray, under_way.slab), under_way.next + 1u);
    return under_way;
}

// Casts a ray from where it is and hands each slab's segment over, until it is behind a slab, finished, or the invocation is
// spent. `place` is what the sink knows the ray by.
fn cast_segments(ray: Ray, furthest: i32, place: SegmentPlace, before: SegmentedRay) -> SegmentedRay {
    let end = end_of_slab(ray, furthest);
    let walk = start_walk(ray.first, ray.step);
    var under_way = before;
    var run_end = 0u;
    while under_way.next < end && under_way.state.is_finished == 0u && !is_spent() {
        stretches++;
        if under_way.next >= run_end {
            let run = next_run(walk, under_way.next, end, 0.0);
            under_way.state.map_reads += run.map_reads;
            leaps += run.map_reads;
            if VALUE_OFFSET != 0.0 && run.begin != under_way.next {
                under_way.segment.scalar = value_at(ray_at(ray, f32(run.begin) + VALUE_OFFSET - 1.0));
            }
            under_way.next = run.begin;
            run_end = run.end;
        }
        // Neighbouring rays enter slabs at other samples: a stretch ends with its slab, so that those in lockstep enter
        // the next together; but if samples are shaded, waiting for each other's last ones costs more.
        while !SHADING_IS_DEAR && under_way.next >= under_way.slab_end {
            under_way = enter_slab(ray, place, under_way);
        }
        let stretch_begin = under_way.next;
        var stretch_end = min(stretch_begin + STRETCH, run_end);
        if !SHADING_IS_DEAR {
            stretch_end = min(stretch_end, under_way.slab_end);
        }
        while under_way.next < stretch_end {
            while SHADING_IS_DEAR && under_way.next >= under_way.slab_end {
                under_way = enter_slab(ray, place, under_way);
            }
            var value = 0.0;
            var is_found = false;
            loop {
                value = value_at(ray_at(ray, f32(under_way.next) + VALUE_OFFSET));
                is_found = may_be_visible(value, under_way.segment.scalar);
                if is_found || !SEARCHES || under_way.next + 1u >= min(stretch_end, under_way.slab_end) {
                    break;
                }
                under_way.segment.scalar = value;
                under_way.next++;
            }
            if is_found {
                under_way.segment = blend(ray, under_way.next, value, under_way.segment);
            }
            under_way.segment.scalar = value;
            under_way.next++;
            let transmittance = under_way.state.transmittance * under_way.segment.transmittance;
            if transmittance <= 1.0 - parameters.termination_alpha {
                under_way.state.is_finished = 1u;
                break;
            }
        }
        under_way.state.samples += under_way.next - stretch_begin;
    }
    under_way.state.is_finished |= select(0u, 1u, under_way.next >= ray.sample_count);
    if under_way.state.is_finished == 1u || under_way.next >= end {
        under_way = leave_segment(place, under_way);
    }
    return under_way;
}
