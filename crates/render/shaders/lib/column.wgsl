import package::lib::layer_words::{layer_color};
import package::lib::layered_warp::{layers, warp};

// Layers between the pixels of a picture, the four of a column side by side in vectors: `core::warp::Column`.

// How steep a surface may be, in depth per width: beyond it neighbouring columns show different surfaces.
const STEEPEST: f32 = 32.0;

// Accumulated opacity that lets nothing through.
const SATURATED_ALPHA: f32 = 0.99999994;

const LEAST_THROUGH: f32 = 1.0 - SATURATED_ALPHA;

const TINY: f32 = 1e-30;

struct Column {
    // Depths between which the layers are, metres.
    start_m: vec4f,
    end_m: vec4f,
    // What they add to the picture: premultiplied colour, less what layers before take.
    r: vec4f,
    g: vec4f,
    b: vec4f,
    a: vec4f,
    // Absorption, 1/m; 0 where a layer is clear.
    absorption_per_m: vec4f,
}

// What a pixel contributes, by its weight.
fn part_of(pixel: vec2f, weight: f32) -> Column {
    let at = vec2i(pixel);
    let first = textureLoad(layers, at, 0, 0);
    let second = textureLoad(layers, at, 1, 0);
    let third = textureLoad(layers, at, 2, 0);
    let fourth = textureLoad(layers, at, 3, 0);
    let depths_m = array(bitcast<vec2f>(first.xy), bitcast<vec2f>(second.xy), bitcast<vec2f>(third.xy), bitcast<vec2f>(fourth.xy));
    let colors = transpose(mat4x4f(layer_color(first), layer_color(second), layer_color(third), layer_color(fourth)));
    return Column(
        vec4f(depths_m[0].x, depths_m[1].x, depths_m[2].x, depths_m[3].x),
        vec4f(depths_m[0].y, depths_m[1].y, depths_m[2].y, depths_m[3].y),
        weight * colors[0],
        weight * colors[1],
        weight * colors[2],
        weight * colors[3],
        vec4f(0.0),
    );
}

// Whether layers so many pixels apart may be of one sheet.
fn agree(a_start_m: vec4f, a_end_m: vec4f, b_start_m: vec4f, b_end_m: vec4f, apart_px: f32) -> vec4<bool> {
    let gap_m = max(a_start_m, b_start_m) - min(a_end_m, b_end_m);
    return gap_m <= STEEPEST * warp.pixel_tangent * max(apart_px, 1.0) * min(a_start_m, b_start_m);
}

// Interpolates the layers of the four pixels about a position, by what they add to the picture.
fn column_at(position: vec2f) -> Column {
    let last = warp.size - 1.0;
    let at = clamp(position - 0.5, vec2f(0.0), last);
    let low = floor(at);
    let along = at - low;
    let high = min(low + 1.0, last);
    let above = united(
        part_of(low, (1.0 - along.x) * (1.0 - along.y)),
        part_of(vec2f(high.x, low.y), along.x * (1.0 - along.y)),
    );
    let below = united(part_of(vec2f(low.x, high.y), (1.0 - along.x) * along.y), part_of(high, along.x * along.y));
    return absorbing(united(above, below), position);
}

// Interpolates between a column and the layers at the middle of a pixel along an axis, by a share of the way there.
fn column_between(before: Column, position: vec2f, axis: vec2f, share: f32) -> Column {
    let last = warp.size - 1.0;
    let at = clamp(position - 0.5, vec2f(0.0), last);
    let low = floor(at + 0.5 * axis);
    let along = dot(at - low, 1.0 - axis);
    let high = min(low + 1.0 - axis, last);
    let there = united(part_of(low, share * (1.0 - along)), part_of(high, share * along));
    return absorbing(united(weighted(before, 1.0 - share), there), position);
}

fn weighted(column: Column, weight: f32) -> Column {
    return Column(
        column.start_m,
        column.end_m,
        weight * column.r,
        weight * column.g,
        weight * column.b,
        weight * column.a,
        vec4f(0.0),
    );
}

// Two columns together. Depths are those of the one that has more of a layer, and of the other if it agrees.
fn united(first: Column, second: Column) -> Column {
    let do_agree = agree(first.start_m, first.end_m, second.start_m, second.end_m, 1.0);
    let has_less = first.a < second.a;
    let first_a = select(first.a, vec4f(0.0), has_less & !do_agree);
    let second_a = select(second.a, vec4f(0.0), !has_less & !do_agree);
    let share = second_a / max(first_a + second_a, vec4f(TINY));
    return Column(
        mix(first.start_m, second.start_m, share),
        mix(first.end_m, second.end_m, share),
        first.r + second.r,
        first.g + second.g,
        first.b + second.b,
        first.a + second.a,
        vec4f(0.0),
    );
}

// A column and what it absorbs at a position.
fn absorbing(column: Column, position: vec2f) -> Column {
    var through: vec4f;
    through.x = 1.0;
    through.y = max(through.x - column.a.x, LEAST_THROUGH);
    through.z = max(through.y - column.a.y, LEAST_THROUGH);
    through.w = max(through.z - column.a.z, LEAST_THROUGH);
    let optical_depth = -log(1.0 - min(column.a / through, vec4f(SATURATED_ALPHA)));
    let metres_per_depth = length(warp.shown_direction + position.x * warp.shown_dx + position.y * warp.shown_dy);
    let length_m = max((column.end_m - column.start_m) * metres_per_depth, vec4f(TINY));
    let absorption_per_m = select(vec4f(0.0), optical_depth / length_m, column.a > vec4f(0.0));
    return Column(column.start_m, column.end_m, column.r, column.g, column.b, column.a, absorption_per_m);
}
