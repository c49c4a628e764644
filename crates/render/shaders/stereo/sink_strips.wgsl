import package::lib::cuts::{note_alpha};
import package::lib::join::{join};
import package::lib::ray_state::{FIRST_HIT_ALPHA};
import package::lib::strips::{partial_at, partial_depths_m, partials};

// Segments go into the partial sums of their strip.

struct SegmentPlace {
    row: u32,
    strip: u32,
    // Sweep column of the ray.
    column: i32,
}

// Puts a segment behind what others have left in the derived column of its slab.
fn put_segment(place: SegmentPlace, slab: i32, segment: vec4f, depth_m: f32) {
    let at = partial_at(place.row, place.strip, place.column - slab);
    let held = partials[at];
    let joint = join(held, segment);
    partials[at] = joint;
    note_alpha(place.row, place.strip, place.column - slab, joint.a);
    if held.a < FIRST_HIT_ALPHA {
        partial_depths_m[at] = depth_m;
    }
}
