import package::lib::view::{view};

// Columns of a strip of which some ray of a band of rows may meet something.

// Columns of a word; a strip has two words of columns.
const WORD_COLUMNS: u32 = 32u;

// A strip in a band of rows.
struct StripBand {
    // A bit for each column.
    listed: vec2u,
    // Stretches that the row which has done the most has done, and reads of the skip map.
    stretches: atomic<u32>,
    leaps: atomic<u32>,
}

struct Strips {
    // Rows of strips that the last dispatch has not finished.
    unfinished: atomic<u32>,
    bands: array<StripBand>,
}

@group(3) @binding(2) var<storage, read_write> strips: Strips;

fn strip_band_at(band: u32, strip: u32) -> u32 {
    return band * view.pair.count + strip;
}

// The bits of the columns before one, counted from the strip's first.
fn columns_before(column: u32) -> vec2u {
    let count = vec2u(min(column, WORD_COLUMNS), max(column, WORD_COLUMNS) - WORD_COLUMNS);
    // A shift by 32 is none.
    return select(vec2u(0u), vec2u(0xffffffffu) >> (WORD_COLUMNS - count), count > vec2u(0u));
}

// The last column of some, which are not none.
fn last_of(columns: vec2u) -> u32 {
    return select(firstLeadingBit(columns.x), WORD_COLUMNS + firstLeadingBit(columns.y), columns.y != 0u);
}

// Whether any listed column reaches one of some derived columns.
fn is_reached(band: u32, first_derived: i32, last_derived: i32) -> bool {
    let first = first_derived + view.pair.furthest - view.pair.first_column;
    let last = last_derived + view.pair.nearest - view.pair.first_column;
    let width = i32(view.pair.width);
    var reaching = vec2u(0u);
    for (var strip = max(first, 0) / width; strip <= min(last / width, i32(view.pair.count) - 1); strip++) {
        let before_first = columns_before(u32(clamp(first - strip * width, 0, width)));
        let to_last = columns_before(u32(clamp(last + 1 - strip * width, 0, width)));
        reaching |= strips.bands[strip_band_at(band, u32(strip))].listed & to_last & ~before_first;
    }
    return any(reaching != vec2u(0u));
}
