import package::lib::cast_parameters::{parameters};
import package::lib::classify::{classify};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{NOTHING_HIT, Pixel, RayState, new_ray_state, pixel_of};
import package::lib::record::{record_surface};
import package::lib::skip::{next_run, start_walk};
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

// `scalar` holds the value before.
fn start_ray(ray: Ray) -> RayState {
    let before = select(f32(ray.first_sample) - 1.0, -0.5, ray.first_sample == 0u);
    return new_ray_state(value_at(ray_at(ray, before)), NOTHING_HIT);
}

// First crossing of the isovalue, in either direction, between a sample and the one before it. The block of either may
// hold the surface, so a run is looked for from the sample before, and goes one beyond the block.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    let walk = start_walk(ray.first, ray.step);
    var state = before;
    var i = begin;
    var value = state.scalar;
    while i < end && state.is_finished == 0u {
        let run = next_run(walk, max(i, 1u) - 1u, end, state.scalar);
        state.map_reads += run.map_reads;
        let has_leapt = run.begin > i;
        i = max(i, run.begin);
        if has_leapt && i < ray.sample_count {
            state.scalar = value_at(ray_at(ray, f32(i) - 1.0));
            state.samples += 1u;
        }
        let run_end = select(end, min(run.end + 1u, end), run.end > run.begin);
        while i < run_end {
            value = value_at(ray_at(ray, f32(i)));
            state.samples += 1u;
            if is_in(value) != is_in(state.scalar) {
                state.is_finished = 1u;
                break;
            }
            state.scalar = value;
            i++;
        }
    }
    if state.is_finished == 0u {
        return state;
    }
    var hi = f32(i);
    var lo = max(hi - 1.0, -0.5);
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
    state.color = shade(ray, position + lift(classified.gradient), parameters.isovalue, classified).rgb;
    state.depth_m = ray_depth_m(ray, index);
    record_surface(state.depth_m);
    return state;
}

fn finish_ray(ray: Ray, state: RayState) -> Pixel {
    let alpha = f32(state.is_finished);
    return pixel_of(vec4f(state.color * alpha, alpha), state);
}
