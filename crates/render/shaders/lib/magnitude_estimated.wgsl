import package::lib::gradient::{gradient_at};

// Gradient magnitudes estimated around each sample.

const HAS_GRADIENT = true;

// Gradient in metric space, and its magnitude.
fn steepness_at(position: vec3f) -> vec4f {
    let gradient = gradient_at(position);
    return vec4f(gradient, length(gradient));
}
