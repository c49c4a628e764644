// Codes of the smallest and the largest value of each block, and of its gradient magnitudes.
@group(0) @binding(2) var values: texture_3d<u32>;
@group(0) @binding(3) var gradients: texture_3d<u32>;
// For each code of a value, or of a gradient magnitude, the first entry of the table that numbers from it upwards fall
// on and the last that numbers up to it do; 256 codes per row.
@group(0) @binding(4) var value_entries: texture_2d<u32>;
@group(0) @binding(5) var gradient_entries: texture_2d<u32>;
// Summed-area table of visible entries, a row and a column of zeros before them.
@group(0) @binding(6) var visible_before: texture_2d<u32>;

fn block_dims() -> vec3u {
    return textureDimensions(values);
}

// The entries that an interval of codes spans: the first, and the one after the last.
fn entries_of(interval: vec2u, entries: texture_2d<u32>) -> vec2u {
    let first = textureLoad(entries, vec2u(interval.x & 255u, interval.x >> 8u), 0).x;
    let last = textureLoad(entries, vec2u(interval.y & 255u, interval.y >> 8u), 0).y;
    return vec2u(first, last + 1u);
}

// By value and gradient magnitude.
fn is_occupied(block: vec3u) -> bool {
    let columns = entries_of(textureLoad(values, block, 0).xy, value_entries);
    let rows = entries_of(textureLoad(gradients, block, 0).xy, gradient_entries);
    let until_end = textureLoad(visible_before, vec2u(columns.y, rows.y), 0).x
        - textureLoad(visible_before, vec2u(columns.x, rows.y), 0).x;
    let until_first = textureLoad(visible_before, vec2u(columns.y, rows.x), 0).x
        - textureLoad(visible_before, vec2u(columns.x, rows.x), 0).x;
    return until_end != until_first;
}
