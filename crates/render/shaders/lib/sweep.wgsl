// Mirror of `skip::distance::SweepUniform`. All numbers count words.

struct Sweep {
    // Lines of words along two axes.
    lines: vec2u,
    // From one line to the next along each.
    line_strides: vec2u,
    // Words of a line.
    length: u32,
    // Where the first line begins.
    start: u32,
    // From one word of a line to the next; wraps around where it is negative.
    step: u32,
    // From where a word is read to where it is written: from one octant to another, or 0.
    to_target: u32,
}

@group(0) @binding(0) var<uniform> sweep: Sweep;
@group(0) @binding(1) var<storage, read_write> field: array<u32>;

// Where an invocation's line begins.
fn line_start(line: vec2u) -> u32 {
    return sweep.start + line.x * sweep.line_strides.x + line.y * sweep.line_strides.y;
}
