import package::lib::layers::{layer_of};
import package::lib::layer_target::{layers};
import package::lib::view::{view};

// Segments go into the layer of their ray.

struct SegmentPlace {
    row: u32,
    // Sweep column of the ray.
    column: i32,
}

// Writes a segment at the derived column of its slab.
fn put_segment(place: SegmentPlace, slab: i32, segment: vec4f, depth_m: f32) {
    let column = place.column - slab;
    if column >= 0 && column < i32(view.width) {
        textureStore(layers, vec2i(column, i32(place.row)), layer_of(place.column), segment);
    }
}
