import package::lib::cast_parameters::{parameters};
import package::lib::view::{view};

// Direction components nearer to zero than this count as this far from it, so that no division overflows.
const PARALLEL: f32 = 1e-12;

// Least squared length that is divided by.
const LEAST_SQUARED: f32 = 1e-30;

struct Ray {
    // Texture position of sample 0.
    first: vec3f,
    // From one sample to the next, texture space.
    step: vec3f,
    // Length of a step, voxel lengths.
    step_length: f32,
    // Number of samples; 0 if the ray misses.
    sample_count: u32,
    // The first sample that is taken.
    first_sample: u32,
    // Depth of sample 0, metres.
    first_depth_m: f32,
    // Depth of a step, metres.
    step_depth_m: f32,
    // From sample 0 to the viewpoint, metric space; a vector that points there if it is infinitely far away.
    to_viewpoint: vec3f,
    // Change of that from one sample to the next.
    to_viewpoint_step: vec3f,
}

// Depths at which a ray enters and leaves the visible box and half-space.
fn visible_interval(origin: vec3f, direction: vec3f) -> vec2f {
    let tiny = select(vec3f(-PARALLEL), vec3f(PARALLEL), direction >= vec3f(0.0));
    let inverse = 1.0 / select(direction, tiny, abs(direction) < vec3f(PARALLEL));
    let at_lo = (parameters.box_lo - origin) * inverse;
    let at_hi = (parameters.box_hi - origin) * inverse;
    let enter = min(at_lo, at_hi);
    let leave = max(at_lo, at_hi);
    var near = max(max(enter.x, enter.y), max(enter.z, view.near_m));
    var far = min(min(leave.x, leave.y), min(leave.z, view.far_m));

    let height = dot(parameters.plane.xyz, origin) + parameters.plane.w;
    var climb = dot(parameters.plane.xyz, direction);
    if abs(climb) < PARALLEL {
        climb = select(-PARALLEL, PARALLEL, climb >= 0.0);
    }
    let crossing = -height / climb;
    if climb > 0.0 {
        near = max(near, crossing);
    } else {
        far = min(far, crossing);
    }
    return vec2f(near, far);
}

// The ray of a pixel; its centre is at (x + 1/2, y + 1/2).
fn ray_of_pixel(pixel: vec2u) -> Ray {
    return ray_through(vec2f(pixel) + 0.5);
}

// The ray through a picture position, in pixels from the top left; it may be beyond the edges.
fn ray_through(at: vec2f) -> Ray {
    let origin = view.origin + at.x * view.origin_dx + at.y * view.origin_dy;
    let direction = view.direction + at.x * view.direction_dx + at.y * view.direction_dy;
    let interval = visible_interval(origin, direction);
    let metric_direction = parameters.metric_from_texture * direction;
    let metres_to_voxel_lengths = length(metric_direction);
    let span = max(interval.y - interval.x, 0.0);

    var ray: Ray;
    ray.sample_count = u32(ceil(span * metres_to_voxel_lengths * parameters.sampling_factor));
    ray.step_depth_m = span / f32(max(ray.sample_count, 1u));
    ray.first_depth_m = interval.x + 0.5 * ray.step_depth_m;
    ray.first = origin + direction * ray.first_depth_m;
    ray.step = direction * ray.step_depth_m;
    ray.step_length = ray.step_depth_m * metres_to_voxel_lengths;
    let viewpoint = view.viewpoint + at.x * view.viewpoint_dx;
    ray.to_viewpoint = parameters.metric_from_texture * (viewpoint.xyz - viewpoint.w * origin)
        - metric_direction * (viewpoint.w * ray.first_depth_m);
    ray.to_viewpoint_step = metric_direction * (-viewpoint.w * ray.step_depth_m);
    return ray;
}

// Texture position of a sample; fractional indices lie between samples.
fn ray_at(ray: Ray, index: f32) -> vec3f {
    return ray.first + ray.step * index;
}

// Unit vector to the viewpoint from where a ray passes a texture position, metric space.
fn viewpoint_direction(ray: Ray, position: vec3f) -> vec3f {
    let index = dot(position - ray.first, ray.step) / max(dot(ray.step, ray.step), LEAST_SQUARED);
    let towards = ray.to_viewpoint + ray.to_viewpoint_step * index;
    return towards * inverseSqrt(max(dot(towards, towards), LEAST_SQUARED));
}

// Depth of a sample, metres.
fn ray_depth_m(ray: Ray, index: f32) -> f32 {
    return ray.first_depth_m + ray.step_depth_m * index;
}

// Whether a texture position is in the visible part of the volume.
fn is_inside(position: vec3f) -> bool {
    return all(position >= parameters.box_lo) && all(position <= parameters.box_hi)
        && dot(parameters.plane.xyz, position) + parameters.plane.w >= 0.0;
}
