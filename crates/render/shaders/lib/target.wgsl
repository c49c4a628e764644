import package::lib::ray_state::{NOTHING_HIT, Pixel};

// Premultiplied RGBA.
@group(2) @binding(0) var color_target: texture_storage_2d<rgba32float, write>;
// Depth of the first hit in metres, samples taken, reads of the skip map, 1 where something was hit.
@group(2) @binding(1) var depth_target: texture_storage_2d<rgba32float, write>;

// What is before a cast.
const BLANK = Pixel(vec4f(0.0), NOTHING_HIT, 0u, 0u);

fn store(pixel: vec2u, finished: Pixel) {
    let is_hit = select(0.0, 1.0, finished.depth_m != NOTHING_HIT);
    textureStore(color_target, pixel, finished.color);
    textureStore(depth_target, pixel, vec4f(finished.depth_m, f32(finished.samples), f32(finished.map_reads), is_hit));
}

// What a ray leaves that meets nothing.
fn store_blank(pixel: vec2u, map_reads: u32) {
    textureStore(depth_target, pixel, vec4f(0.0, 0.0, f32(map_reads), 0.0));
}
