import package::lib::cast_parameters::{parameters};
import package::lib::classify::{classify};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{NOTHING_HIT, Pixel, RayState};
import package::lib::shade::{shade};
import package::lib::volume::{value_at};

// Halvings of the step in which an isosurface is found: to a thousandth of a voxel length.
const BISECTIONS: u32 = 10u;

// How far above an isosurface its shading rays start, voxel lengths.
const SURFACE_LIFT: f32 = 0.5;

// From a surface to where its shading rays start: a little towards lower values, so that rounding does not put half
// of the surface into its own shadow. Texture space.
fn lift(gradient: vec3f) -> vec3f {
    let squared = dot(gradient, gradient);
    if squared == 0.0 {
        return vec3f(0.0);
    }
    return parameters.texture_from_metric * (gradient * (-SURFACE_LIFT * inverseSqrt(squared)));
}

fn is_in(value: f32) -> bool {
    return value >= parameters.isovalue;
}

// `scalar` holds the value before, `transmittance` the index of its sample.
fn start_ray(ray: Ray) -> RayState {
    return RayState(vec3f(0.0), -0.5, NOTHING_HIT, value_at(ray_at(ray, -0.5)), 0u, 0u);
}

// First crossing of the isovalue, in either direction.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    var state = before;
    var i = begin;
    var value = state.scalar;
    while i < end {
        value = value_at(ray_at(ray, f32(i)));
        if is_in(value) != is_in(state.scalar) {
            state.is_finished = 1u;
            break;
        }
        state.scalar = value;
        state.transmittance = f32(i);
        i++;
    }
    state.samples += i - begin;
    if state.is_finished == 0u {
        return state;
    }
    state.samples += 1u;
    var lo = state.transmittance;
    var hi = f32(i);
    for (var k = 0u; k < BISECTIONS; k++) {
        let middle = 0.5 * (lo + hi);
        if is_in(value_at(ray_at(ray, middle))) == is_in(value) {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    let index = 0.5 * (lo + hi);
    let position = ray_at(ray, index);
    let classified = classify(position, parameters.isovalue, parameters.isovalue);
    state.color = shade(ray, position + lift(classified.gradient), classified);
    state.depth_m = ray_depth_m(ray, index);
    return state;
}

fn finish_ray(ray: Ray, state: RayState) -> Pixel {
    let alpha = f32(state.is_finished);
    return Pixel(vec4f(state.color * alpha, alpha), state.depth_m, state.samples);
}
