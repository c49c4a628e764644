import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::lut_2d::{lut_at_2d};
import package::lib::volume::{value_at};

// One-dimensional transfer function integrated between the values at both ends of a step.

// An empty block lets all light through.
const EMPTY_IS_CLEAR = true;

const CLASSIFIER_IS_DEAR = false;

const CLASSIFIER_HAS_GRADIENT = false;

// Where on the ray, counted in steps from a sample's middle, the value that classifies it is taken.
const VALUE_OFFSET: f32 = 0.5;

// Whether a sample may be visible, from its value and the one before it on the ray.
fn may_be_visible(value: f32, previous: f32) -> bool {
    return max(value, previous) >= parameters.visible.x && min(value, previous) <= parameters.visible.y;
}

fn classify(position: vec3f, value: f32, previous: f32) -> Classified {
    return Classified(lut_at_2d(previous, value), vec3f(0.0));
}

// Log2 transmittance of one voxel length, for shading rays.
fn log2_transmittance_at(position: vec3f) -> f32 {
    let value = value_at(position);
    return lut_at_2d(value, value).w;
}
