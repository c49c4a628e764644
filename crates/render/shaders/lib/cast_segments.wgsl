import package::lib::cast_parameters::{parameters};
import package::lib::classify::{VALUE_OFFSET, may_be_visible};
import package::lib::composite::{BLENDING_IS_DEAR, SEARCHES, blend};
import package::lib::join::{join};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, RayState, STRETCH};
import package::lib::segment_sink::{SegmentPlace, put_segment};
import package::lib::segmented_ray::{SegmentedRay, is_spent, leaps, stretches};
import package::lib::skip::{next_run, start_walk};
import package::lib::slabs::{end_of_slab, slab_at};
import package::lib::splat::{splat};
import package::lib::view::{view};
import package::lib::volume::{value_at};

// Rays of the reference view cut into segments, one for each slab of depth: all samples of a slab land on the same derived
// columns. `depth_m` of a segment is that of its first sample.

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

// Hands over the segment that a ray has left behind, if it is not clear, with what was carried on to its slab, and carries on what
// of it belongs to the next one.
fn leave_segment(ray: Ray, place: SegmentPlace, before: SegmentedRay) -> SegmentedRay {
    var under_way = before;
    if under_way.segment.transmittance < 1.0 {
        let parts = splat(ray, under_way);
        put_segment(place, under_way.slab, join(under_way.carried, parts.here), under_way.segment.depth_m);
        under_way.state = append(under_way.state, under_way.segment);
        under_way.carried = parts.next;
        under_way.slab--;
        under_way.segment.color = vec3f(0.0);
        under_way.segment.transmittance = 1.0;
        under_way.moment = 0.0;
    }
    return under_way;
}

// Hands over what was carried on to a slab, unless a ray goes on there: it goes on in `slab`.
fn leave_carried(place: SegmentPlace, slab: i32, before: SegmentedRay) -> SegmentedRay {
    var under_way = before;
    while under_way.carried.a > 0.0 && slab < under_way.slab {
        put_segment(place, under_way.slab, under_way.carried, under_way.segment.depth_m);
        under_way.carried = vec4f(0.0);
    }
    return under_way;
}

// Leaves the segment, and begins that of the next sample's slab.
fn enter_slab(ray: Ray, place: SegmentPlace, before: SegmentedRay) -> SegmentedRay {
    var under_way = leave_segment(ray, place, before);
    let depth_m = ray_depth_m(ray, f32(under_way.next));
    // A ray has one segment in each slab, however the bounds are rounded.
    let slab = min(slab_at(depth_m), under_way.slab);
    under_way = leave_carried(place, slab, under_way);
    under_way.segment.depth_m = depth_m;
    under_way.slab = slab;
    under_way.slab_end = max(end_of_slab(ray, slab), under_way.next + 1u);
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
        while !BLENDING_IS_DEAR && under_way.next >= under_way.slab_end {
            under_way = enter_slab(ray, place, under_way);
        }
        let stretch_begin = under_way.next;
        var stretch_end = min(stretch_begin + STRETCH, run_end);
        if !BLENDING_IS_DEAR {
            stretch_end = min(stretch_end, under_way.slab_end);
        }
        while under_way.next < stretch_end {
            var value = 0.0;
            var is_found = false;
            loop {
                value = value_at(ray_at(ray, f32(under_way.next) + VALUE_OFFSET));
                is_found = may_be_visible(value, under_way.segment.scalar);
                if is_found || !SEARCHES || under_way.next + 1u >= stretch_end {
                    break;
                }
                under_way.segment.scalar = value;
                under_way.next++;
            }
            while BLENDING_IS_DEAR && is_found && under_way.next >= under_way.slab_end {
                under_way = enter_slab(ray, place, under_way);
            }
            if is_found {
                let transmittance = under_way.segment.transmittance;
                under_way.segment = blend(ray, under_way.next, value, under_way.segment);
                under_way.moment += (transmittance - under_way.segment.transmittance) * f32(under_way.next);
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
        under_way = leave_carried(place, furthest - 1, leave_segment(ray, place, under_way));
    }
    return under_way;
}
