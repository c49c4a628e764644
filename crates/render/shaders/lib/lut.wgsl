import package::lib::cast_parameters::{parameters};

// Colour and log2 transmittance of one voxel length, the value axis fastest.
@group(1) @binding(2) var<storage, read> lut: array<vec4f>;

fn lut_index(coordinate: f32, count: u32) -> u32 {
    return min(u32(coordinate * f32(count - 1u) + 0.5), count - 1u);
}

// The entry nearest to a normalised value; of a two-dimensional table its first row.
fn lut_at(value: f32) -> vec4f {
    return lut[lut_index(value, parameters.lut_size.x)];
}

// The entry nearest to a normalised value and a second coordinate in [0, 1].
fn lut_at_2d(value: f32, second: f32) -> vec4f {
    let row = lut_index(second, parameters.lut_size.y);
    return lut[row * parameters.lut_size.x + lut_index(value, parameters.lut_size.x)];
}
