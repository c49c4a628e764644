// Colour and log2 transmittance of one voxel length by value: per entry the mean colour from it to the next (11, 11 and 10
// bits, red lowest), the logarithm, and how much the next one's differs. A look-up reads one entry, in three parts:
// software Vulkan gathers each for itself, and from a uniform far faster than from a storage buffer.
@group(1) @binding(3) var<uniform> lut: array<vec4u, 4096>;

// The entry at a normalised value: the logarithm interpolated, the colour to an 8192th of its change.
fn lut_at(value: f32) -> vec4f {
    let along = value * 4095.0;
    let before = min(u32(along), 4094u);
    let entry = lut[before];
    let rgb = vec3f(vec3u(entry.x & 2047u, (entry.x >> 11u) & 2047u, entry.x >> 22u))
        * vec3f(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0);
    let fraction = along - f32(before);
    return vec4f(rgb, bitcast<f32>(entry.y) + fraction * bitcast<f32>(entry.z));
}
