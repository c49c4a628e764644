const VOXELS_PER_WORD: u32 = 4u;

// Texels of numbers from 0 to 1.
fn texels_of(numbers: vec4f) -> u32 {
    return pack4x8unorm(numbers);
}
