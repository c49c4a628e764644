import package::lib::cast_parameters::{parameters};
import package::lib::classify::{CLASSIFIER_IS_DEAR, VALUE_OFFSET, classify};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, Pixel, RayState, new_ray_state, pixel_of};
import package::lib::shade::{SHADING_IS_DEAR, shade};
import package::lib::skip::{RUNS_ARE_DENSE};
import package::lib::volume::{value_at};

// Whether to search for the next visible sample before blending it: a driver that runs both sides of every branch
// (software Vulkan) then blends no other. Not worth it where most are visible and blending is cheap.
const SEARCHES = CLASSIFIER_IS_DEAR || SHADING_IS_DEAR || !RUNS_ARE_DENSE;

// `scalar` holds the value of the sample before, where the classifier asks for it.
fn start_ray(ray: Ray) -> RayState {
    if VALUE_OFFSET == 0.0 {
        return new_ray_state(0.0, NOTHING_HIT);
    }
    return new_ray_state(value_at(ray_at(ray, f32(ray.first_sample) + VALUE_OFFSET - 1.0)), NOTHING_HIT);
}

// Puts sample i, which may be visible, behind what the ray has gathered.
fn blend(ray: Ray, i: u32, value: f32, before: RayState) -> RayState {
    var state = before;
    let position = ray_at(ray, f32(i));
    let classified = classify(position, value, state.scalar);
    let step_transmittance = exp2(classified.entry.w * ray.step_length);
    let rgb = shade(ray, position, classified);
    state.color += rgb * ((1.0 - step_transmittance) * state.transmittance);
    state.transmittance *= step_transmittance;
    if state.depth_m == NOTHING_HIT && state.transmittance <= 1.0 - FIRST_HIT_ALPHA {
        state.depth_m = ray_depth_m(ray, f32(i));
    }
    return state;
}

fn is_opaque(state: RayState) -> bool {
    return state.transmittance <= 1.0 - parameters.termination_alpha;
}

fn finish_ray(ray: Ray, state: RayState) -> Pixel {
    return pixel_of(vec4f(state.color, 1.0 - state.transmittance), state);
}
