import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::lut_1d::{lut_at};
import package::lib::volume::{value_at};

// One-dimensional transfer function.

// An empty block lets all light through.
const EMPTY_IS_CLEAR = true;

const CLASSIFIER_IS_DEAR = false;

const CLASSIFIER_HAS_GRADIENT = false;

// Where on the ray, counted in steps from a sample's middle, the value that classifies it is taken.
const VALUE_OFFSET: f32 = 0.0;

// Whether a sample may be visible, from its value and the one before it on the ray.
fn may_be_visible(value: f32, previous: f32) -> bool {
    return value >= parameters.visible.x && value <= parameters.visible.y;
}

fn classify(position: vec3f, value: f32, previous: f32) -> Classified {
    return Classified(lut_at(value), vec3f(0.0));
}

// Log2 transmittance of one voxel length, for shading rays.
fn log2_transmittance_at(position: vec3f) -> f32 {
    return lut_at(value_at(position)).w;
}
