import package::lib::cast_parameters::{parameters};
import package::lib::layer_words::{layer_words};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::ray_state::{RayState};
import package::lib::view::{view};

// Thickness below which a layer is not divided, widths of a pixel.
const DIVIDED_PX: f32 = 16.0;

// Cuts rays into layers of emission and absorption (VR Alg. 7): `Recorder` of `core::reference::layers`.

// The layers of each pixel from the front, as `lib/layer_words`.
@group(2) @binding(4) var layer_target: texture_storage_2d_array<rgba32uint, write>;

// The layer that a ray is in.
struct OpenLayer {
    // What the ray had gathered before it.
    color: vec3f,
    transmittance: f32,
    // Depths between which it is so far, metres; it has not begun if they are the same.
    start_m: f32,
    end_m: f32,
    // Its number.
    index: u32,
    // That of the layer which the next visible sample is in.
    next: u32,
}

var<private> layers_pixel: vec2u;
var<private> open_layer: OpenLayer;

fn begin_recording(pixel: vec2u) {
    layers_pixel = pixel;
    open_layer = OpenLayer(vec3f(0.0), 1.0, 0.0, 0.0, 0u, 0u);
}

fn begin_stretch(ray: Ray, i: u32, state: RayState) -> u32 {
    return 0xffffffffu;
}

// Adds sample i, between two states of its ray.
fn record(ray: Ray, i: u32, before: RayState, after: RayState) {
    let begins_m = ray_depth_m(ray, f32(i) - 0.5);
    let has_begun = open_layer.start_m < open_layer.end_m;
    let gap_is_long = begins_m - open_layer.end_m > open_layer.end_m - open_layer.start_m;
    let ends_before_gap = has_begun && gap_is_long && open_layer.index + 1u < parameters.layer_count;
    let index = max(open_layer.next, open_layer.index + select(0u, 1u, ends_before_gap));
    let is_visible = after.transmittance < before.transmittance;
    let begins = is_visible && (!has_begun || index > open_layer.index);
    // A loop and no branch: software Vulkan would write for every sample.
    var is_left = begins && has_begun;
    while is_left {
        end_layer(before);
        is_left = false;
    }
    if begins {
        open_layer = OpenLayer(before.color, before.transmittance, begins_m, begins_m, index, index);
    }
    if is_visible {
        open_layer.end_m = ray_depth_m(ray, f32(i) + 0.5);
        let is_passed = parameters.layer_thresholds <= vec4f(1.0 - after.transmittance);
        let passed = u32(dot(select(vec4f(0.0), vec4f(1.0), is_passed), vec4f(1.0)));
        let width = length(parameters.metric_from_texture * (view.origin_dx + view.direction_dx * open_layer.end_m));
        let thickness = (open_layer.end_m - open_layer.start_m) * (ray.step_length / ray.step_depth_m);
        let is_over = thickness >= DIVIDED_PX * width && passed > open_layer.index && passed < parameters.layer_count;
        open_layer.next = select(open_layer.index, passed, is_over);
    }
}

fn end_recording(state: RayState) {
    end_layer(state);
}

// Writes the layer that a ray is in, which has gathered what it has in all.
fn end_layer(state: RayState) {
    let layer = open_layer;
    if layer.start_m < layer.end_m {
        let color = vec4f(state.color - layer.color, layer.transmittance - state.transmittance);
        textureStore(layer_target, layers_pixel, layer.index, layer_words(layer.start_m, layer.end_m, color));
    }
}
