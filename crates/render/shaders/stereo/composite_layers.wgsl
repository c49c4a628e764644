import package::lib::cast_parameters::{parameters};
import package::lib::layers::{layer_of};
import package::lib::pair::{mirrored, pair};
import package::lib::ray::{ray_depth_m, ray_through};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, Pixel};
import package::lib::slabs::{end_of_slab};
import package::lib::target::{store};
import package::lib::view::{BAND_ROWS, first_pixel_of_group, is_outside_piece, view};

// Composites the layers of each derived pixel, from the ray whose nearest slab is seen there on (SP Alg. 3).

@group(3) @binding(1) var layers: texture_2d_array<f32>;

@compute @workgroup_size(BAND_ROWS, BAND_ROWS)
fn composite_layers(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let pixel = first_pixel_of_group(group) + local.xy;
    if is_outside_piece(pixel) {
        return;
    }
    let column = mirrored(i32(pixel.x), view.width);
    let at = vec2i(column, i32(pixel.y));
    let furthest = max(pair.furthest, pair.first_column - column);
    var slab = min(pair.nearest, pair.first_column + i32(pair.column_count) - 1 - column);
    var color = vec4f(0.0);
    // Slabs from the first hit on.
    var hit_slab = furthest - 1;
    while slab >= furthest && color.a < parameters.termination_alpha {
        color += textureLoad(layers, at, layer_of(column + slab), 0) * (1.0 - color.a);
        if color.a >= FIRST_HIT_ALPHA {
            hit_slab = max(hit_slab, slab);
        }
        slab--;
    }
    var depth_m = NOTHING_HIT;
    if hit_slab >= furthest {
        depth_m = middle_depth_m(column + hit_slab, pixel.y, hit_slab);
    }
    store(pixel, Pixel(color, depth_m, 0u, 0u));
}

// Depth of the middle of a ray's samples in a slab.
fn middle_depth_m(column: i32, row: u32, slab: i32) -> f32 {
    let ray = ray_through(vec2f(f32(mirrored(column, view.width)), f32(row)) + 0.5);
    let begin = end_of_slab(ray, slab + 1);
    let end = end_of_slab(ray, slab);
    return ray_depth_m(ray, 0.5 * (f32(begin) + f32(end) - 1.0));
}
