const BOUNDARIES_TAKE_GRADIENT = false;

// A log2 transmittance as it is.
fn at_boundary(log2_transmittance: f32, gradient: vec3f) -> f32 {
    return log2_transmittance;
}
