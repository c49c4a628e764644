import package::lib::cast_parameters::{parameters};

const BOUNDARIES_TAKE_GRADIENT = true;

// What boundary enhancement makes of a log2 transmittance where the value changes by a gradient.
fn at_boundary(log2_transmittance: f32, gradient: vec3f) -> f32 {
    let magnitude = min(length(gradient), 1.0);
    let gained = parameters.boundary_gain * pow(magnitude, parameters.boundary_exponent);
    return log2_transmittance * (parameters.boundary_inside + gained);
}
