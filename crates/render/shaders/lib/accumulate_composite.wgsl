import package::lib::classify::{VALUE_OFFSET, may_be_visible};
import package::lib::composite::{SEARCHES, blend, finish_ray, is_opaque, start_ray};
import package::lib::ray::{Ray, ray_at};
import package::lib::ray_state::{RayState, STRETCH};
import package::lib::record::{begin_stretch, end_recording, record};
import package::lib::skip::{next_run, start_walk};
import package::lib::volume::{value_at};

// Loop iterations of a sample at most, without those of its shading: of the search, or of slabs and samples.
const ITERATIONS_PER_SAMPLE = select(3u, 5u, SEARCHES);

// Front-to-back emission and absorption.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    let walk = start_walk(ray.first, ray.step);
    var state = before;
    var i = begin;
    while i < end && state.is_finished == 0u {
        let run = next_run(walk, i, end, state.scalar);
        state.map_reads += run.map_reads;
        if VALUE_OFFSET != 0.0 && run.begin != i {
            state.scalar = value_at(ray_at(ray, f32(run.begin) + VALUE_OFFSET - 1.0));
        }
        i = run.begin;
        let stretch_end = min(min(i + STRETCH, run.end), begin_stretch(ray, i, state));
        while i < stretch_end {
            var value = 0.0;
            var is_found = false;
            loop {
                value = value_at(ray_at(ray, f32(i) + VALUE_OFFSET));
                is_found = may_be_visible(value, state.scalar);
                if is_found || !SEARCHES || i + 1u >= stretch_end {
                    break;
                }
                state.scalar = value;
                i++;
            }
            if is_found {
                let before = state;
                state = blend(ray, i, value, before);
                record(ray, i, before, state);
            }
            state.scalar = value;
            i++;
            if is_opaque(state) {
                state.is_finished = 1u;
                break;
            }
        }
        state.samples += i - run.begin;
    }
    end_recording(state);
    return state;
}
