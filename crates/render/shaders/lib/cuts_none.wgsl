import package::lib::ray::{Ray};
import package::lib::segmented_ray::{SegmentedRay};

// What rays that end leave out of the derived picture is not asked for.

fn empty_cut(row: u32, strip: u32, column: i32) {}

fn is_cut_at(row: u32, strip: u32, column: i32) -> bool {
    return false;
}

fn note_alpha(row: u32, strip: u32, column: i32, alpha: f32) {}

fn note_cut(row: u32, strip: u32, column: i32, ray: Ray, ended: SegmentedRay) {}
