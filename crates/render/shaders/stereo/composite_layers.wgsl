import package::lib::join::{color_of, is_full, join};
import package::lib::layers::{layer_of};
import package::lib::mirrored::{mirrored};
import package::lib::ray::{ray_depth_m, ray_through};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, Pixel};
import package::lib::slabs::{bounds_of_slab_m};
import package::lib::target::{store};
import package::lib::view::{BAND_ROWS, first_pixel_of_group, is_outside_piece, view};

// Joins the layers of each derived pixel, from the ray whose nearest slab is seen there on (SP Alg. 3).

@group(3) @binding(0) var layers: texture_2d_array<f32>;

@compute @workgroup_size(BAND_ROWS, BAND_ROWS)
fn composite_layers(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let pixel = first_pixel_of_group(group) + local.xy;
    if is_outside_piece(pixel) {
        return;
    }
    let column = mirrored(i32(pixel.x));
    let at = vec2i(column, i32(pixel.y));
    let furthest = max(view.pair.furthest, view.pair.first_column - column);
    var slab = min(view.pair.nearest, view.pair.first_column + i32(view.pair.column_count) - 1 - column);
    var joint = vec4f(0.0);
    // Slabs from the first hit on.
    var hit_slab = furthest - 1;
    while slab >= furthest && !is_full(joint) {
        joint = join(joint, textureLoad(layers, at, layer_of(column + slab), 0));
        if joint.a >= FIRST_HIT_ALPHA {
            hit_slab = max(hit_slab, slab);
        }
        slab--;
    }
    var depth_m = NOTHING_HIT;
    if hit_slab >= furthest {
        depth_m = middle_depth_m(column + hit_slab, pixel.y, hit_slab);
    }
    store(pixel, Pixel(color_of(joint), depth_m, 0u, 0u));
}

// Depth of the middle of a slab, of the part of it that a ray has samples in.
fn middle_depth_m(column: i32, row: u32, slab: i32) -> f32 {
    let ray = ray_through(vec2f(f32(mirrored(column)), f32(row)) + 0.5);
    let last_depth_m = ray_depth_m(ray, f32(ray.sample_count) - 1.0);
    let bounds_m = clamp(bounds_of_slab_m(slab), vec2f(ray.first_depth_m), vec2f(last_depth_m));
    return 0.5 * (bounds_m.x + bounds_m.y);
}
