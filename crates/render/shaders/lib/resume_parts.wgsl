import package::lib::front::{start_behind};
import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState};
import package::lib::view::{view};

// Rays of a piece that are cast in several dispatches, row by row.
@group(2) @binding(2) var<storage, read_write> states: array<RayState>;

fn begin_ray(ray: Ray, pixel: vec2u, slot: u32) -> RayState {
    // Software Vulkan compiles a kernel anew for each value of a uniform that decides a branch alone; a slot that no ray has
    // joins in.
    if view.first_sample == u32(slot == 0xffffffffu) {
        return start_behind(ray, pixel);
    }
    return states[slot];
}

fn keep_ray(slot: u32, state: RayState) {
    states[slot] = state;
}
