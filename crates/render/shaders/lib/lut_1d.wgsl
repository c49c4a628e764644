// Colour and log2 transmittance of one voxel length by value. Looked up by interpolating the logarithm between entries
// and taking the colour of the nearest entry. A uniform: software Vulkan reads it far faster than a storage buffer.
@group(1) @binding(3) var<uniform> lut: array<vec4f, 4096>;

// The entry at a normalised value.
fn lut_at(value: f32) -> vec4f {
    let along = value * 4095.0;
    let before = min(u32(along), 4094u);
    let fraction = along - f32(before);
    let nearest = before + u32(fraction + 0.5);
    return vec4f(lut[nearest].rgb, mix(lut[before].w, lut[before + 1u].w, fraction));
}
