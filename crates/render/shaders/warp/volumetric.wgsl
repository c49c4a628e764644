import package::lib::column::{Column, SATURATED_ALPHA, TINY, agree, column_at, column_between};
import package::lib::cover_picture::{cover_picture};
import package::lib::depth_range::{NOTHING, joined};
import package::lib::layered_warp::{range, tiles, warp};

// Novel rays through layers of emission and absorption (VR Alg. 8): `core::warp::volumetric`.

// Times that the depths which a ray may find something at are narrowed to those of the tiles that it passes.
const NARROWINGS: u32 = 2u;

// A ray ends when no more than this passes it.
const LEAST_TRANSMITTANCE: f32 = 0.01;

// Side of a tile, pixels.
const TILE_SIDE: f32 = 16.0;

// A ray of the wanted view: at a depth s of that view, metres, it is at the homogeneous pixel `from_eye + s * per_m` of the
// shown view, whose z is the depth in the shown view.
struct NovelRay {
    from_eye: vec3f,
    per_m: vec3f,
    // Length per metre of depth.
    metres_per_depth: f32,
}

// Where a ray is: pixel and depth in the shown view, depth in the wanted view.
struct Place {
    pixel: vec2f,
    shown_m: f32,
    wanted_m: f32,
}

// The way of a ray in the shown picture, cut where it passes the middles of pixels along the axis that it mostly follows.
struct Path {
    // Where it begins.
    first: vec2f,
    // Its change per pixel along the axis.
    per_px: vec2f,
    axis: vec2f,
    // Its length along the axis, pixels.
    length_px: f32,
    // From its beginning to the middle of a pixel that is no further on than that.
    middle_px: f32,
    // Whole pixels of a step.
    stride_px: f32,
    steps: f32,
}

// Light of a novel ray, gathered front to back.
struct Light {
    rgb: vec3f,
    transmittance: f32,
}

@fragment
fn warp_volumetric(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = position.xy;
    let direction = warp.wanted_direction + at.x * warp.wanted_dx + at.y * warp.wanted_dy;
    let ray = NovelRay(warp.epipole, warp.matrix * vec3f(at, 1.0), length(direction));
    let light = light_along(ray);
    return vec4f(light.rgb, 1.0 - light.transmittance);
}

fn light_along(ray: NovelRay) -> Light {
    var light = Light(vec3f(0.0), 1.0);
    let stretch_m = stretch_of(ray);
    let first = place_at(ray, stretch_m.x);
    let last = place_at(ray, stretch_m.y);
    let path = path_between(first.pixel, last.pixel, stretch_m.x < stretch_m.y);
    let goes_forward = first.shown_m <= last.shown_m;
    var here = first;
    var here_px = 0.0;
    var column = column_at(first.pixel);
    for (var step = 1.0; step <= path.steps && light.transmittance > LEAST_TRANSMITTANCE; step += 1.0) {
        let middle_px = path.middle_px + step * path.stride_px;
        let there_px = min(middle_px, path.length_px);
        let fraction = select(there_px / path.length_px, 1.0, there_px >= path.length_px);
        let there = place_at(ray, between(first, last, fraction));
        let middle = path.first + middle_px * path.per_px;
        let next = column_between(column, middle, path.axis, (there_px - here_px) / (middle_px - here_px));
        let step_m = (there.wanted_m - here.wanted_m) * ray.metres_per_depth;
        light = through_step(light, here, there, column, next, path.stride_px, step_m, goes_forward);
        here = there;
        here_px = middle_px;
        column = next;
    }
    return light;
}

fn path_between(first: vec2f, last: vec2f, is_there: bool) -> Path {
    let way = last - first;
    let axis = select(vec2f(0.0, 1.0), vec2f(1.0, 0.0), abs(way.x) >= abs(way.y));
    let along = dot(way, axis);
    let past_middle = fract(dot(first, axis) - 0.5);
    let middle_px = select(-past_middle, past_middle - 1.0, along < 0.0 && past_middle > 0.0);
    let length_px = abs(along);
    let pixels = max(ceil(length_px - middle_px), 1.0);
    let stride_px = ceil(pixels / warp.most_steps);
    let steps = ceil(pixels / stride_px);
    let per_px = way / max(length_px, TINY);
    return Path(first, per_px, axis, length_px, middle_px, stride_px, select(0.0, steps, is_there));
}

fn place_at(ray: NovelRay, wanted_m: f32) -> Place {
    let point = ray.from_eye + wanted_m * ray.per_m;
    return Place(point.xy / point.z, point.z, wanted_m);
}

// Depth in the wanted view at a fraction of the way in the shown picture, metres.
fn between(first: Place, last: Place, fraction: f32) -> f32 {
    let a = (1.0 - fraction) * last.shown_m;
    let b = fraction * first.shown_m;
    return (a * first.wanted_m + b * last.wanted_m) / (a + b);
}

// The depths in the wanted view between which a ray may find something; none if the first is not less.
fn stretch_of(ray: NovelRay) -> vec2f {
    var clipped_m = clipped(ray, warp.wanted_m, textureLoad(range, vec2u(0u), 0).xy);
    for (var i = 0u; i < NARROWINGS; i++) {
        let around_m = depths_around(place_at(ray, clipped_m.x).pixel, place_at(ray, clipped_m.y).pixel, clipped_m);
        clipped_m = clipped(ray, clipped_m, around_m);
    }
    return clipped_m;
}

// Depths of the tiles about two positions.
fn depths_around(first: vec2f, last: vec2f, clipped_m: vec2f) -> vec2f {
    let most = vec2f(textureDimensions(tiles)) - 1.0;
    // A pixel more on each side, which interpolation reads.
    let low = vec2i(clamp(floor((min(first, last) - 1.0) / TILE_SIDE), vec2f(0.0), most));
    let high = vec2i(clamp(floor((max(first, last) + 1.0) / TILE_SIDE), vec2f(0.0), most));
    var depths_m = NOTHING;
    let end = select(low.y, high.y + 1, clipped_m.x < clipped_m.y);
    for (var y = low.y; y < end; y++) {
        for (var x = low.x; x <= high.x; x++) {
            depths_m = joined(depths_m, textureLoad(tiles, vec2i(x, y), 0).xy);
        }
    }
    return depths_m;
}

// The part of an interval of depths within the picture and within a range of depths of the shown view.
fn clipped(ray: NovelRay, depths_m: vec2f, shown_m: vec2f) -> vec2f {
    let from_eye = ray.from_eye;
    let per_m = ray.per_m;
    var part = within(depths_m, from_eye.x, per_m.x);
    part = within(part, warp.size.x * from_eye.z - from_eye.x, warp.size.x * per_m.z - per_m.x);
    part = within(part, from_eye.y, per_m.y);
    part = within(part, warp.size.y * from_eye.z - from_eye.y, warp.size.y * per_m.z - per_m.y);
    part = within(part, from_eye.z - shown_m.x, per_m.z);
    return within(part, shown_m.y - from_eye.z, -per_m.z);
}

// The part of an interval in which `a + b * s` is not negative.
fn within(part: vec2f, a: f32, b: f32) -> vec2f {
    let root = -a / select(b, TINY, b == 0.0);
    let above = vec2f(max(part.x, root), part.y);
    let below = vec2f(part.x, min(part.y, root));
    let all = select(part, part.xx, a < 0.0);
    return select(select(all, below, b < 0.0), above, b > 0.0);
}

// Composites the layers that a step crosses. Where the columns agree on where a layer is, it is a sheet from one to the other;
// else half a step is in each.
fn through_step(
    before: Light,
    here: Place,
    there: Place,
    column: Column,
    next: Column,
    step_px: f32,
    step_m: f32,
    goes_forward: bool,
) -> Light {
    let is_clear = column.a <= vec4f(0.0);
    let next_is_clear = next.a <= vec4f(0.0);
    let start_m = select(column.start_m, next.start_m, is_clear);
    let end_m = select(column.end_m, next.end_m, is_clear);
    let next_start_m = select(next.start_m, column.start_m, next_is_clear);
    let next_end_m = select(next.end_m, column.end_m, next_is_clear);
    let is_sheet = agree(start_m, end_m, next_start_m, next_end_m, step_px);
    let share = select(vec4f(0.0), vec4f(1.0), is_sheet);
    // Of the first sheet: from this column to the next, or of this column alone.
    let to_start_m = select(start_m, next_start_m, is_sheet);
    let to_end_m = select(end_m, next_end_m, is_sheet);
    let first_part = part_inside(here, there, start_m, end_m, to_start_m, to_end_m, vec4f(0.0), 0.5 + 0.5 * share);
    let second_part =
        part_inside(here, there, next_start_m, next_end_m, next_start_m, next_end_m, 0.5 + 0.5 * share, vec4f(1.0));
    let middle = share * min(first_part.begin + 0.5 * first_part.length, vec4f(1.0));
    let absorption = mix(column.absorption_per_m, next.absorption_per_m, middle) * thinning(column, next, middle);
    let first_depth = absorption * first_part.length * step_m;
    let first = exp(-first_depth);
    let second = exp(-next.absorption_per_m * second_part.length * step_m);
    // Where about the middle of what is seen of a sheet is: halfway through a translucent one, at the front of an opaque one.
    let seen_at = share * min(first_part.begin + first_part.length / (2.0 + first_depth), vec4f(1.0));
    let a = max(mix(column.a, next.a, seen_at), vec4f(TINY));
    let next_a = max(next.a, vec4f(TINY));
    var colors = transpose(
        mat3x4f(mix(column.r, next.r, seen_at) / a, mix(column.g, next.g, seen_at) / a, mix(column.b, next.b, seen_at) / a),
    );
    var next_colors = transpose(mat3x4f(next.r / next_a, next.g / next_a, next.b / next_a));
    var passed = first;
    var next_passed = second;
    if !goes_forward {
        colors = mat4x3f(colors[3], colors[2], colors[1], colors[0]);
        next_colors = mat4x3f(next_colors[3], next_colors[2], next_colors[1], next_colors[0]);
        passed = passed.wzyx;
        next_passed = next_passed.wzyx;
    }
    var light = add(before, passed.x, next_passed.x, colors[0], next_colors[0]);
    light = add(light, passed.y, next_passed.y, colors[1], next_colors[1]);
    light = add(light, passed.z, next_passed.z, colors[2], next_colors[2]);
    return add(light, passed.w, next_passed.w, colors[3], next_colors[3]);
}

// What is between two columns is as opaque as the picture is there, interpolated between pixels: an opaque surface beside nothing
// ends halfway, where it would still be nearly opaque if absorptions were interpolated. What these are to be multiplied by.
fn thinning(column: Column, next: Column, share: vec4f) -> vec4f {
    let alphas = min(vec2f(dot(column.a, vec4f(1.0)), dot(next.a, vec4f(1.0))), vec2f(SATURATED_ALPHA));
    let optical_depths = -log(1.0 - alphas);
    let interpolated = mix(vec4f(optical_depths.x), vec4f(optical_depths.y), share);
    return -log(1.0 - mix(vec4f(alphas.x), vec4f(alphas.y), share)) / max(interpolated, vec4f(TINY));
}

// Adds two stretches of a layer, by what passes them.
fn add(before: Light, first: f32, second: f32, rgb: vec3f, next_rgb: vec3f) -> Light {
    let after = before.transmittance * first;
    let color = before.rgb + (before.transmittance - after) * rgb + (after * (1.0 - second)) * next_rgb;
    return Light(color, after * second);
}

// A part of a step.
struct Part {
    begin: vec4f,
    length: vec4f,
}

// What of a step, from one share of it to another, is in sheets.
fn part_inside(
    here: Place,
    there: Place,
    start_m: vec4f,
    end_m: vec4f,
    to_start_m: vec4f,
    to_end_m: vec4f,
    first: vec4f,
    last: vec4f,
) -> Part {
    let below = here.shown_m - start_m;
    let below_slope = there.shown_m - to_start_m - below;
    let above = end_m - here.shown_m;
    let above_slope = to_end_m - there.shown_m - above;
    var begin = first;
    var end = last;
    let below_root = -below / select(below_slope, vec4f(TINY), below_slope == vec4f(0.0));
    let above_root = -above / select(above_slope, vec4f(TINY), above_slope == vec4f(0.0));
    begin = select(begin, max(begin, below_root), below_slope > vec4f(0.0));
    end = select(end, min(end, below_root), below_slope < vec4f(0.0));
    end = select(end, begin, below_slope == vec4f(0.0) & below < vec4f(0.0));
    begin = select(begin, max(begin, above_root), above_slope > vec4f(0.0));
    end = select(end, min(end, above_root), above_slope < vec4f(0.0));
    end = select(end, begin, above_slope == vec4f(0.0) & above < vec4f(0.0));
    return Part(begin, max(end - begin, vec4f(0.0)));
}
