import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState};

// Casts that keep no layers.

fn begin_layers(pixel: vec2u) {}

fn record(ray: Ray, i: u32, before: RayState, after: RayState) {}

fn end_layer(state: RayState) {}
