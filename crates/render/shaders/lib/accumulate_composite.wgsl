import package::lib::classify::{VALUE_OFFSET, may_be_visible};
import package::lib::composite::{blend, finish_ray, is_opaque, start_ray};
import package::lib::ray::{Ray, ray_at};
import package::lib::ray_state::{RayState};
import package::lib::volume::{value_at};

// Front-to-back emission and absorption in one flat loop: for samples that cost little to blend.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    var state = before;
    var i = begin;
    while i < end {
        let value = value_at(ray_at(ray, f32(i) + VALUE_OFFSET));
        if may_be_visible(value, state.scalar) {
            state = blend(ray, i, value, state);
        }
        state.scalar = value;
        i++;
        if is_opaque(state) {
            state.is_finished = 1u;
            break;
        }
    }
    state.samples += i - begin;
    return state;
}
