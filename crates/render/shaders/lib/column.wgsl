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
fn column_at(position: vec2f, metres_per_depth: f32) -> Column {
    let last = warp.size - 1.0;
    let at = clamp(position - 0.5, vec2f(0.0), last);
    let low = min(floor(at), max(last - 1.0, vec2f(0.0)));
    let along = at - low;
    let high = min(low + 1.0, last);
    let c0 = part_of(low, (1.0 - along.x) * (1.0 - along.y));
    let c1 = part_of(vec2f(high.x, low.y), along.x * (1.0 - along.y));
    let c2 = part_of(vec2f(low.x, high.y), (1.0 - along.x) * along.y);
    let c3 = part_of(high, along.x * along.y);
    // Depths are those of the pixel that has most of a layer and of others that agree.
    let second = c1.a >= c0.a;
    let most_of_two = select(c0.a, c1.a, second);
    let third = c2.a >= most_of_two;
    let most_of_three = select(most_of_two, c2.a, third);
    let fourth = c3.a >= most_of_three;
    let start_m = select(select(select(c0.start_m, c1.start_m, second), c2.start_m, third), c3.start_m, fourth);
    let end_m = select(select(select(c0.end_m, c1.end_m, second), c2.end_m, third), c3.end_m, fourth);
    let w0 = select(vec4f(0.0), c0.a, agree(start_m, end_m, c0.start_m, c0.end_m, 1.0));
    let w1 = select(vec4f(0.0), c1.a, agree(start_m, end_m, c1.start_m, c1.end_m, 1.0));
    let w2 = select(vec4f(0.0), c2.a, agree(start_m, end_m, c2.start_m, c2.end_m, 1.0));
    let w3 = select(vec4f(0.0), c3.a, agree(start_m, end_m, c3.start_m, c3.end_m, 1.0));
    let per_weight = 1.0 / max(w0 + w1 + w2 + w3, vec4f(TINY));
    var column: Column;
    column.start_m = per_weight * (w0 * c0.start_m + w1 * c1.start_m + w2 * c2.start_m + w3 * c3.start_m);
    column.end_m = per_weight * (w0 * c0.end_m + w1 * c1.end_m + w2 * c2.end_m + w3 * c3.end_m);
    column.r = c0.r + c1.r + c2.r + c3.r;
    column.g = c0.g + c1.g + c2.g + c3.g;
    column.b = c0.b + c1.b + c2.b + c3.b;
    column.a = c0.a + c1.a + c2.a + c3.a;
    var through: vec4f;
    through.x = 1.0;
    through.y = max(through.x - column.a.x, LEAST_THROUGH);
    through.z = max(through.y - column.a.y, LEAST_THROUGH);
    through.w = max(through.z - column.a.z, LEAST_THROUGH);
    let optical_depth = -log(1.0 - min(column.a / through, vec4f(SATURATED_ALPHA)));
    let length_m = max((column.end_m - column.start_m) * metres_per_depth, vec4f(TINY));
    column.absorption_per_m = select(vec4f(0.0), optical_depth / length_m, column.a > vec4f(0.0));
    return column;
}

// The layers from the back.
fn reversed(column: Column) -> Column {
    return Column(
        column.start_m.wzyx,
        column.end_m.wzyx,
        column.r.wzyx,
        column.g.wzyx,
        column.b.wzyx,
        column.a.wzyx,
        column.absorption_per_m.wzyx,
    );
}
