import package::lib::classify::{VALUE_OFFSET, may_be_visible};
import package::lib::composite::{blend, finish_ray, is_opaque, start_ray};
import package::lib::ray::{Ray, ray_at};
import package::lib::ray_state::{RayState};
import package::lib::volume::{value_at};

// Samples after which neighbouring rays, one of which may wait at a visible sample, are together again.
const STRETCH: u32 = 16u;

// Front-to-back emission and absorption. The innermost loop only searches for the next visible sample: a driver that
// runs both sides of every branch (software Vulkan) then blends no other.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    var state = before;
    var i = begin;
    while i < end && state.is_finished == 0u {
        let stretch_end = min(i + STRETCH, end);
        while i < stretch_end {
            var value = 0.0;
            var is_found = false;
            loop {
                value = value_at(ray_at(ray, f32(i) + VALUE_OFFSET));
                is_found = may_be_visible(value, state.scalar);
                if is_found {
                    break;
                }
                state.scalar = value;
                i++;
                if i >= stretch_end {
                    break;
                }
            }
            if !is_found {
                break;
            }
            state = blend(ray, i, value, state);
            state.scalar = value;
            i++;
            if is_opaque(state) {
                state.is_finished = 1u;
                break;
            }
        }
    }
    state.samples += i - begin;
    return state;
}
