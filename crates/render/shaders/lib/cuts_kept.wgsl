import package::lib::cast_parameters::{parameters};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::segment_sink::{SegmentPlace};
import package::lib::segmented_ray::{SegmentedRay};
import package::lib::slabs::{slab_at};
import package::lib::strips::{partial_at, partials};

// What rays that end leave out of the derived picture.

// Opacity in front of what is missing from which on it is not missed: less than a tenth of the light.
const HIDING_ALPHA: f32 = 0.9;

// 1 for each derived column of a strip that a ray would have gone on to, with less than that in front.
@group(3) @binding(4) var<storage, read_write> partial_cuts: array<u32>;

fn empty_cut(at: u32) {
    partial_cuts[at] = 0u;
}

fn is_cut_at(at: u32, alpha_in_front: f32) -> bool {
    return partial_cuts[at] == 1u && alpha_in_front < HIDING_ALPHA;
}

// Notes some derived columns that are still open.
fn note_columns(place: SegmentPlace, first: i32, last: i32) {
    for (var column = first; column <= last; column++) {
        let at = partial_at(place.row, place.strip, column);
        if partials[at].a < HIDING_ALPHA {
            partial_cuts[at] = 1u;
        }
    }
}

// Notes what a ray leaves out that is opaque: the derived columns of the slabs behind. `noted` are the first and the last that
// have been looked at for rays of later columns; what these left open is noted. Returns the first and the last by now.
fn note_cut(place: SegmentPlace, ray: Ray, ended: SegmentedRay, noted: vec2i) -> vec2i {
    let first = place.column - ended.slab + 1;
    let last = place.column - slab_at(ray_depth_m(ray, f32(ray.sample_count) - 0.5));
    let is_cut = ended.state.transmittance <= 1.0 - parameters.termination_alpha && last >= first;
    if !is_cut || ray.sample_count == 0u {
        return noted;
    }
    let is_first = noted.x > noted.y;
    note_columns(place, first, select(noted.x - 1, last, is_first));
    note_columns(place, select(noted.y, last, is_first) + 1, last);
    return vec2i(min(noted.x, first), max(noted.y, last));
}
