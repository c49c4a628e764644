import package::lib::ray::{Ray};
import package::lib::segment_sink::{SegmentPlace};
import package::lib::segmented_ray::{SegmentedRay};

// What rays that end leave out of the derived picture is not asked for.

fn empty_cut(row: u32, strip: u32, column: i32) {}

fn is_cut_at(row: u32, strip: u32, column: i32) -> bool {
    return false;
}

fn note_cut(place: SegmentPlace, ray: Ray, ended: SegmentedRay, noted: vec2i) -> vec2i {
    return noted;
}
