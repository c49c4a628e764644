// Squared gradient below which a sample has no surface to light.
const FLAT_SQUARED: f32 = 1e-10;
