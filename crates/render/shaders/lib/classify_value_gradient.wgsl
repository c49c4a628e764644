import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::lut_2d::{lut_at_2d};
import package::lib::magnitude::{HAS_GRADIENT, steepness_at};
import package::lib::volume::{value_at};

// Two-dimensional transfer function of value and gradient magnitude.

// An empty block lets all light through.
const EMPTY_IS_CLEAR = true;

const CLASSIFIER_IS_DEAR = true;

const CLASSIFIER_HAS_GRADIENT = HAS_GRADIENT;

// Where on the ray, counted in steps from a sample's middle, the value that classifies it is taken.
const VALUE_OFFSET: f32 = 0.0;

// Whether a sample may be visible, from its value and the one before it on the ray.
fn may_be_visible(value: f32, previous: f32) -> bool {
    return value >= parameters.visible.x && value <= parameters.visible.y;
}

fn classify(position: vec3f, value: f32, previous: f32) -> Classified {
    let steepness = steepness_at(position);
    return Classified(lut_at_2d(value, min(steepness.w, 1.0)), steepness.xyz);
}

// Log2 transmittance of one voxel length, for shading rays.
fn log2_transmittance_at(position: vec3f) -> f32 {
    let value = value_at(position);
    return classify(position, value, value).entry.w;
}
