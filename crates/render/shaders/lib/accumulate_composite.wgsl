import package::lib::cast_parameters::{parameters};
import package::lib::classify::{classify, may_be_visible};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{NOTHING_HIT, Pixel, RayState};
import package::lib::shade::{shade};
import package::lib::volume::{value_at};

// Accumulated opacity at which a ray has hit something: the first that an 8-bit picture shows.
const FIRST_HIT_ALPHA: f32 = 1.0 / 255.0;

fn start_ray(ray: Ray) -> RayState {
    return RayState(vec3f(0.0), 1.0, NOTHING_HIT, value_at(ray_at(ray, -0.5)), 0u, 0u);
}

// Front-to-back emission and absorption. The inner loop only searches: a driver that runs both sides of every
// branch (software Vulkan) then shades visible samples alone.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    var state = before;
    let smallest_transmittance = 1.0 - parameters.termination_alpha;
    var i = begin;
    while i < end {
        var position = ray_at(ray, f32(i));
        var value = value_at(position);
        while !may_be_visible(value, state.scalar) {
            state.scalar = value;
            i++;
            if i >= end {
                break;
            }
            position = ray_at(ray, f32(i));
            value = value_at(position);
        }
        if i >= end {
            break;
        }
        let classified = classify(position, value, state.scalar);
        let step_transmittance = exp2(classified.entry.w * ray.step_length);
        if step_transmittance < 1.0 {
            let rgb = shade(ray, position, classified);
            state.color += rgb * ((1.0 - step_transmittance) * state.transmittance);
            state.transmittance *= step_transmittance;
            if state.depth_m == NOTHING_HIT && state.transmittance <= 1.0 - FIRST_HIT_ALPHA {
                state.depth_m = ray_depth_m(ray, f32(i));
            }
        }
        state.scalar = value;
        i++;
        if state.transmittance <= smallest_transmittance {
            state.is_finished = 1u;
            break;
        }
    }
    state.samples += i - begin;
    return state;
}

fn finish_ray(ray: Ray, state: RayState) -> Pixel {
    return Pixel(vec4f(state.color, 1.0 - state.transmittance), state.depth_m, state.samples);
}
