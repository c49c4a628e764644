import package::lib::composite::{is_opaque, start_ray};
import package::lib::ray::{Ray};
import package::lib::ray_state::{NOTHING_HIT, RayState};

// Rays of composites that go on behind a picture of what is nearer, in the formats of the targets (`lib/target.wgsl`).
@group(2) @binding(5) var front_color: texture_2d<f32>;
@group(2) @binding(6) var front_depth: texture_2d<f32>;

fn start_behind(ray: Ray, pixel: vec2u) -> RayState {
    let color = textureLoad(front_color, pixel, 0);
    let depth_and_counts = textureLoad(front_depth, pixel, 0);
    var state = start_ray(ray);
    state.color = color.rgb;
    state.transmittance = 1.0 - color.a;
    state.depth_m = select(NOTHING_HIT, depth_and_counts.x, depth_and_counts.w > 0.0);
    state.samples = u32(depth_and_counts.y);
    state.map_reads = u32(depth_and_counts.z);
    state.is_finished = u32(is_opaque(state));
    return state;
}
