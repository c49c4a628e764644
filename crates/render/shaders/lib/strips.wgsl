// Mirror of `uniforms::StripUniform`. Columns are sweep columns: nearer is further left in the derived picture.

struct Strips {
    // Disparity times depth, pixels and metres.
    k: f32,
    // Slab m is where k / z is in (m - 1 + offset, m + offset].
    offset: f32,
    // The slab furthest from the eye and the nearest.
    furthest: i32,
    nearest: i32,
    // First column that is cast.
    first_column: i32,
    // Columns that are cast.
    column_count: u32,
    // Columns of a strip.
    width: u32,
    // Strips of a row.
    count: u32,
    // The columns of each strip that a dispatch takes, counted from the strip's last.
    begin: u32,
    end: u32,
    // 1 where columns count from the right.
    is_mirrored: u32,
}

@group(3) @binding(0) var<uniform> strips: Strips;
// What each strip adds to the derived columns that its rays reach: premultiplied RGBA; zero at first.
@group(3) @binding(1) var<storage, read_write> partials: array<vec4f>;
// Depth of the first hit of each, metres; 0 without one.
@group(3) @binding(2) var<storage, read_write> partial_depths_m: array<f32>;

// Derived columns that a strip reaches.
fn reach() -> u32 {
    return strips.width + u32(strips.nearest - strips.furthest);
}

// First derived column that a strip reaches.
fn first_reached(strip: u32) -> i32 {
    return strips.first_column + i32(strip * strips.width) - strips.nearest;
}

fn partial_at(row: u32, strip: u32, column: i32) -> u32 {
    return (row * strips.count + strip) * reach() + u32(column - first_reached(strip));
}

// From a column of a picture to the sweep column, and back.
fn mirrored(column: i32, picture_width: u32) -> i32 {
    return select(column, i32(picture_width) - 1 - column, strips.is_mirrored == 1u);
}
