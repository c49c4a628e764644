import package::lib::boundaries::{BOUNDARIES_TAKE_GRADIENT, at_boundary};
import package::lib::cast_parameters::{parameters};
import package::lib::classify::{CLASSIFIER_HAS_GRADIENT, CLASSIFIER_IS_DEAR, VALUE_OFFSET, classify};
import package::lib::gradient::{gradient_at};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, Pixel, RayState, new_ray_state, pixel_of};
import package::lib::shade::{SHADING_IS_DEAR, SHADING_TAKES_GRADIENT, shade};
import package::lib::skip::{RUNS_ARE_DENSE};
import package::lib::volume::{value_at};

const BLENDING_TAKES_GRADIENT = SHADING_TAKES_GRADIENT || BOUNDARIES_TAKE_GRADIENT;

// Whether more is asked for a visible sample than the table.
const BLENDING_IS_DEAR = SHADING_IS_DEAR || BOUNDARIES_TAKE_GRADIENT;

// Whether to search for the next visible sample before blending it: a driver that runs both sides of every branch
// (software Vulkan) then blends no other. Not worth it where most are visible and blending is cheap.
const SEARCHES = CLASSIFIER_IS_DEAR || BLENDING_IS_DEAR || !RUNS_ARE_DENSE;

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
    var classified = classify(position, value, state.scalar);
    if BLENDING_TAKES_GRADIENT && !CLASSIFIER_HAS_GRADIENT {
        classified.gradient = gradient_at(position);
    }
    let lit = shade(ray, position, value, classified);
    let step_transmittance = exp2(at_boundary(lit.w, classified.gradient) * ray.step_length);
    state.color += lit.rgb * ((1.0 - step_transmittance) * state.transmittance);
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
