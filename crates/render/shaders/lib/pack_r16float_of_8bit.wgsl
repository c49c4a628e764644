const VOXELS_PER_WORD: u32 = 2u;

// Texels of numbers from 0 to 1: 8-bit codes as they are.
fn texels_of(numbers: vec4f) -> u32 {
    return pack2x16float(round(numbers.xy * 255.0));
}
