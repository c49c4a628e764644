import package::lib::first_hits::{HIT_TILE, NOWHERE_M, nearness_of};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::ray_state::{RayState};
import package::lib::view::{view};

// Notes where the rays of each tile see something first: `core::first_hits::FirstHits`.

// Nearness by tiles, row by row; 0 where nothing is seen.
@group(2) @binding(8) var<storage, read_write> nearness: array<atomic<u32>>;

var<private> recorded_tile: u32;
var<private> visible_from_m: f32;

fn begin_recording(pixel: vec2u) {
    let columns = (view.width + HIT_TILE - 1u) / HIT_TILE;
    recorded_tile = pixel.y / HIT_TILE * columns + pixel.x / HIT_TILE;
    visible_from_m = NOWHERE_M;
}

fn begin_stretch(ray: Ray, i: u32, state: RayState) -> u32 {
    return 0xffffffffu;
}

// Adds sample i, between two states of its ray.
fn record(ray: Ray, i: u32, before: RayState, after: RayState) {
    let is_first = before.transmittance == 1.0 && after.transmittance < 1.0;
    visible_from_m = select(visible_from_m, ray_depth_m(ray, f32(i)), is_first);
}

fn end_recording(state: RayState) {
    record_surface(visible_from_m);
}

// Adds what a ray has met at a depth, metres.
fn record_surface(depth_m: f32) {
    if depth_m < NOWHERE_M {
        atomicMax(&nearness[recorded_tile], nearness_of(depth_m));
    }
}
