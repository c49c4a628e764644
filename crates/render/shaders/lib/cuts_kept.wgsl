import package::lib::cast_parameters::{parameters};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::segment_sink::{SegmentPlace};
import package::lib::segmented_ray::{SegmentedRay};
import package::lib::slabs::{slab_at};
import package::lib::strips::{first_reached, partial_at, partials, reach};
import package::lib::view::{view};

// What rays that end leave out of the derived picture.

// Opacity of a derived pixel from which on what is missing is not missed: it lets less than a tenth of the light through.
const HIDING_ALPHA: f32 = 0.9;

// A bit for each derived column of a row of a strip that a ray would have gone on to, with less than that in front by then.
@group(3) @binding(4) var<storage, read_write> cuts: array<u32>;

const CUTS_PER_WORD: u32 = 32u;

// The word of a derived column.
fn word_at(row: u32, strip: u32, column: i32) -> u32 {
    let words = (reach() + CUTS_PER_WORD - 1u) / CUTS_PER_WORD;
    return (row * view.pair.count + strip) * words + u32(column - first_reached(strip)) / CUTS_PER_WORD;
}

fn bit_of(strip: u32, column: i32) -> u32 {
    return 1u << (u32(column - first_reached(strip)) % CUTS_PER_WORD);
}

fn empty_cut(row: u32, strip: u32, column: i32) {
    cuts[word_at(row, strip, column)] = 0u;
}

fn is_cut_at(row: u32, strip: u32, column: i32) -> bool {
    return (cuts[word_at(row, strip, column)] & bit_of(strip, column)) != 0u;
}

// Notes some derived columns that are still open.
fn note_columns(place: SegmentPlace, first: i32, last: i32) {
    for (var column = first; column <= last; column++) {
        if partials[partial_at(place.row, place.strip, column)].a < HIDING_ALPHA {
            cuts[word_at(place.row, place.strip, column)] |= bit_of(place.strip, column);
        }
    }
}

// Notes what a ray leaves out that is opaque: the derived columns of the slabs behind and the one after them. `noted` are the
// first and the last that have been looked at for rays of later columns; what these left open is noted. Returns the first and
// the last by now.
fn note_cut(place: SegmentPlace, ray: Ray, ended: SegmentedRay, noted: vec2i) -> vec2i {
    let first = place.column - ended.slab;
    let last = place.column - slab_at(ray_depth_m(ray, f32(ray.sample_count) - 0.5)) + 1;
    let is_cut = ended.state.transmittance <= 1.0 - parameters.termination_alpha && last >= first;
    if !is_cut || ray.sample_count == 0u {
        return noted;
    }
    let is_first = noted.x > noted.y;
    note_columns(place, first, select(noted.x - 1, last, is_first));
    note_columns(place, select(noted.y, last, is_first) + 1, last);
    return vec2i(min(noted.x, first), max(noted.y, last));
}
