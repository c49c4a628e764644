import package::lib::view::{view};

// What each strip of columns adds to the derived columns that its rays reach.

// Joints of segments.
@group(3) @binding(0) var<storage, read_write> partials: array<vec4f>;
// Depth of the first hit of each, metres; of the last segment if they let more light through than that.
@group(3) @binding(1) var<storage, read_write> partial_depths_m: array<f32>;

// Derived columns that a strip reaches.
fn reach() -> u32 {
    return view.pair.width + u32(view.pair.nearest - view.pair.furthest);
}

// First derived column that a strip reaches.
fn first_reached(strip: u32) -> i32 {
    return view.pair.first_column + i32(strip * view.pair.width) - view.pair.nearest;
}

fn partial_at(row: u32, strip: u32, column: i32) -> u32 {
    return (row * view.pair.count + strip) * reach() + u32(column - first_reached(strip));
}
