import package::lib::cast_parameters::{parameters};
import package::lib::ray::{Ray, ray_depth_m};
import package::lib::segmented_ray::{SegmentedRay, leaps};
import package::lib::skip::{next_run, start_walk};
import package::lib::slabs::{end_of_slab, slab_at, start_of_slab};
import package::lib::strips::{first_reached, reach};
import package::lib::view::{view};

// What rays that end leave out of the derived picture.

// Opacity of a derived pixel from which on what is missing is not missed: it lets less than a tenth of the light through.
const HIDING_ALPHA: f32 = 0.9;

// Two words for each 32 derived columns of a row of a strip. A bit of the first: the column is as opaque as that. Of the second: it
// is not, and a ray that has ended would have gone on to something there.
@group(3) @binding(4) var<storage, read_write> cuts: array<vec2u>;

const CUTS_PER_WORD: u32 = 32u;

// The words of a derived column, counted from the first that the strip reaches.
fn words_at(row: u32, strip: u32, from_first: u32) -> u32 {
    let words = (reach() + CUTS_PER_WORD - 1u) / CUTS_PER_WORD;
    return (row * view.pair.count + strip) * words + from_first / CUTS_PER_WORD;
}

fn bit_of(from_first: u32) -> u32 {
    return 1u << (from_first % CUTS_PER_WORD);
}

fn empty_cut(row: u32, strip: u32, column: i32) {
    cuts[words_at(row, strip, u32(column - first_reached(strip)))] = vec2u(0u);
}

fn is_cut_at(row: u32, strip: u32, column: i32) -> bool {
    let from_first = u32(column - first_reached(strip));
    return (cuts[words_at(row, strip, from_first)].y & bit_of(from_first)) != 0u;
}

// Notes how opaque a derived column has become.
fn note_alpha(row: u32, strip: u32, column: i32, alpha: f32) {
    let from_first = u32(column - first_reached(strip));
    cuts[words_at(row, strip, from_first)].x |= select(0u, bit_of(from_first), alpha >= HIDING_ALPHA);
}

// Bits from one on to another.
fn bits_between(first: u32, last: u32) -> u32 {
    return (0xffffffffu << first) & (0xffffffffu >> (CUTS_PER_WORD - 1u - last));
}

// Notes what a ray leaves out that is opaque: the derived columns of the slabs behind, and the one after each, that still let
// light through and in whose slab the ray would have met something.
fn note_cut(row: u32, strip: u32, column: i32, ray: Ray, ended: SegmentedRay) {
    let furthest = slab_at(ray_depth_m(ray, f32(ray.sample_count) - 0.5));
    let is_cut = ended.state.transmittance <= 1.0 - parameters.termination_alpha && ray.sample_count > 0u;
    let first = u32(column - ended.slab - first_reached(strip));
    let last = min(u32(column - furthest + 1 - first_reached(strip)), reach() - 1u);
    let walk = start_walk(ray.first, ray.step);
    var word = first / CUTS_PER_WORD;
    while is_cut && word <= last / CUTS_PER_WORD {
        let start = word * CUTS_PER_WORD;
        let at = words_at(row, strip, start);
        let bits = bits_between(max(first, start) - start, min(last - start, CUTS_PER_WORD - 1u));
        let held = cuts[at];
        var open = bits & ~(held.x | held.y);
        var cut = 0u;
        while open != 0u {
            let from_first = start + firstTrailingBit(open);
            let slab = column - first_reached(strip) - i32(from_first);
            let begin = max(start_of_slab(ray, min(slab + 1, view.pair.nearest)), ended.next);
            let end = end_of_slab(ray, max(slab, view.pair.furthest));
            let run = next_run(walk, begin, end, 0.0);
            leaps += run.map_reads + 1u;
            cut |= select(0u, bit_of(from_first), run.begin < run.end);
            open &= open - 1u;
        }
        cuts[at].y |= cut;
        word++;
    }
}
