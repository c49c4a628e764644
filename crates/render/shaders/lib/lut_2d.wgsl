import package::lib::cast_parameters::{parameters};
import package::lib::volume::{trilinear};

// Colour and log2 transmittance of one voxel length, the value along x. A texture, whose filter interpolates both: software
// Vulkan reads it several times faster than a storage buffer.
@group(1) @binding(2) var lut_2d: texture_2d<f32>;

// The entry at a normalised value and a second coordinate in [0, 1].
fn lut_at_2d(value: f32, second: f32) -> vec4f {
    let size = vec2f(parameters.lut_size);
    let at = (vec2f(value, second) * (size - 1.0) + 0.5) / size;
    return textureSampleLevel(lut_2d, trilinear, at, 0.0);
}
