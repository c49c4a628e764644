import package::lib::cast_parameters::{parameters};

// Colour and log2 transmittance of one voxel length, the value axis fastest. Looked up by interpolating the logarithm
// between entries and taking the colour of the nearest entry.
@group(1) @binding(2) var<storage, read> lut_2d: array<vec4f>;

// The entry before a coordinate in [0, 1] that has one after it.
fn lut_before(along: f32, count: u32) -> u32 {
    return min(u32(along), count - 2u);
}

fn lut_at_in_row(row: u32, value: f32) -> vec4f {
    let along = value * f32(parameters.lut_size.x - 1u);
    let column = lut_before(along, parameters.lut_size.x);
    let fraction = along - f32(column);
    let before = row * parameters.lut_size.x + column;
    let nearest = before + u32(fraction + 0.5);
    return vec4f(lut_2d[nearest].rgb, mix(lut_2d[before].w, lut_2d[before + 1u].w, fraction));
}

// The entry at a normalised value and a second coordinate in [0, 1].
fn lut_at_2d(value: f32, second: f32) -> vec4f {
    let along = second * f32(parameters.lut_size.y - 1u);
    let row = lut_before(along, parameters.lut_size.y);
    let fraction = along - f32(row);
    let below = lut_at_in_row(row, value);
    let above = lut_at_in_row(row + 1u, value);
    return vec4f(select(below.rgb, above.rgb, fraction >= 0.5), mix(below.w, above.w, fraction));
}
