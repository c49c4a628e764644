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

// Notes what a ray leaves out that is opaque: the derived columns of the slabs behind. Those from `noted` on have been looked
// at for rays of later columns; what these left open is noted. Returns the first that has been looked at.
fn note_cut(place: SegmentPlace, ray: Ray, ended: SegmentedRay, noted: i32) -> i32 {
    if ended.state.transmittance > 1.0 - parameters.termination_alpha || ray.sample_count == 0u {
        return noted;
    }
    let first = place.column - ended.slab + 1;
    var reached = min(place.column - slab_at(ray_depth_m(ray, f32(ray.sample_count) - 0.5)), noted - 1);
    while reached >= first {
        let at = partial_at(place.row, place.strip, reached);
        if partials[at].a < HIDING_ALPHA {
            partial_cuts[at] = 1u;
        }
        reached--;
    }
    return min(noted, first);
}
