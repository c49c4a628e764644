import package::lib::warp::{depth_source, nearest_texel, warp};

// The surface of a picture's first hits (VR 5.3.2), and what rays of the wanted view meet of it: `core::warp::grid`.

// Steps of a ray along its epipolar line at most.
const MOST_STEPS: f32 = 128.0;

// Least change of what a ray is in front of, per pixel that it goes.
const LEAST_SLOPE: f32 = 0.25;

// What pixels that are torn from what is hit count for.
const TORN_WEIGHT: f32 = 1e-9;

// More than any disparity.
const FAR_PX: f32 = 1e30;

// The ray of a wanted pixel in the shown picture.
struct Ray {
    // Where it comes from infinity, pixels.
    start: vec2f,
    // Unit vector along its epipolar line; 0 if the ray is at one pixel at every depth.
    along: vec2f,
    // Disparity, pixels, per inverse depth.
    disparity_m: f32,
    // Largest disparity in front of the wanted view's near plane and of what is in the picture.
    furthest_px: f32,
}

// What a ray meets: shares of the four pixels from one on, and where they are together in the shown view, 1/m.
struct Meeting {
    is_any: bool,
    first: vec2f,
    shares: vec4f,
    inverse_depth: f32,
}

// The ray through a pixel that is far away at a homogeneous pixel of the shown picture, in front of its eye.
fn ray_through(h: vec3f) -> Ray {
    let start = h.xy / h.z;
    let direction = warp.epipole.xy - warp.epipole.z * start;
    let length_px = length(direction);
    let nearest_depth_m = warp.near_m * h.z + warp.epipole.z;
    let nearest = select(warp.nearest, min(warp.nearest, 1.0 / nearest_depth_m), nearest_depth_m > 0.0);
    let along = select(vec2f(0.0), direction / length_px, length_px > 0.0);
    return Ray(start, along, length_px, nearest * length_px);
}

fn meeting_of(ray: Ray) -> Meeting {
    let step_px = max(ray.furthest_px / MOST_STEPS, 1.0);
    var at_px = (floor(ray.furthest_px / step_px) + 1.0) * step_px;
    var before_px = disparity_px(ray, at_px);
    var is_in_front = before_px <= at_px;
    // What is behind the hole that the ray goes through, and where.
    var behind_px = FAR_PX;
    var behind_at_px = 0.0;
    var slope = FAR_PX;
    while at_px > 0.0 {
        at_px = max(at_px - step_px, 0.0);
        let here_px = disparity_px(ray, at_px);
        let rise_px = here_px - before_px;
        let is_reached = here_px >= at_px;
        let enters = is_in_front && is_reached;
        let is_hit = enters && rise_px <= warp.tear_px * step_px;
        if is_hit {
            slope = max(1.0 + rise_px / step_px, LEAST_SLOPE);
            behind_at_px = at_px + min((here_px - at_px) / slope, step_px);
            behind_px = behind_at_px;
            break;
        }
        if enters && rise_px <= warp.close_px && before_px < behind_px {
            behind_px = before_px;
            behind_at_px = at_px + step_px;
        }
        is_in_front = !is_reached;
        before_px = here_px;
    }
    return meeting_about(ray, behind_at_px, behind_px, slope);
}

// What is about where a ray is at a disparity, bilinear among pixels that are not torn from another disparity. If the surface
// there lets the ray come closer at a slope, it is followed to where both meet.
fn meeting_about(ray: Ray, at_px: f32, about_px: f32, slope: f32) -> Meeting {
    let at = ray.start + at_px * ray.along - 0.5;
    let first = floor(at);
    let depths_m = textureGather(0, depth_source, nearest_texel, (first + 1.0) * warp.pixel).wzxy;
    let inverse_depths = select(vec4f(0.0), 1.0 / depths_m, depths_m > vec4f(0.0));
    let disparities = ray.disparity_m * inverse_depths;
    let counts = select(vec4f(1.0), vec4f(TORN_WEIGHT), abs(disparities - about_px) > vec4f(warp.tear_px));
    let met_px = dot(weights(at - first, counts), disparities);
    let moved = at + ray.along * ((met_px - at_px) / slope);
    let shares = weights(clamp(moved - first, vec2f(0.0), vec2f(1.0)), counts);
    return Meeting(about_px < FAR_PX, first, shares, dot(shares, inverse_depths));
}

fn weights(along: vec2f, counts: vec4f) -> vec4f {
    let x = vec4f(1.0 - along.x, along.x, 1.0 - along.x, along.x);
    let y = vec4f(1.0 - along.y, 1.0 - along.y, along.y, along.y);
    let weights = x * y * counts;
    return weights / dot(weights, vec4f(1.0));
}

// Disparity of the pixel, or of the nearest, that a ray is at.
fn disparity_px(ray: Ray, at_px: f32) -> f32 {
    let at = (ray.start + at_px * ray.along) * warp.pixel;
    let depth_m = textureSampleLevel(depth_source, nearest_texel, at, 0.0).x;
    return select(0.0, ray.disparity_m / depth_m, depth_m > 0.0);
}
