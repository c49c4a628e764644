import package::lib::front::{start_behind};
import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState};
import package::lib::record::{OpenLayer, open_layer};
import package::lib::view::{view};

// Rays of a piece that are cast in several dispatches and cut into layers, row by row.
@group(2) @binding(2) var<storage, read_write> states: array<LayeredRay>;

struct LayeredRay {
    state: RayState,
    layer: OpenLayer,
}

fn begin_ray(ray: Ray, pixel: vec2u, slot: u32) -> RayState {
    // As in `resume_parts`.
    if view.first_sample == u32(slot == 0xffffffffu) {
        return start_behind(ray, pixel);
    }
    open_layer = states[slot].layer;
    return states[slot].state;
}

fn keep_ray(slot: u32, state: RayState) {
    states[slot] = LayeredRay(state, open_layer);
}
