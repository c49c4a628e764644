import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::gradient::{gradient_at};
import package::lib::volume::{value_at};

// Opaque from the isovalue upwards.

// An empty block has no surface, but may be all inside.
const EMPTY_IS_CLEAR = false;

const CLASSIFIER_IS_DEAR = false;

const CLASSIFIER_HAS_GRADIENT = true;

// The logarithm that stands for an opacity of 1.
const OPAQUE_LOG2: f32 = -1000.0;

fn classify(position: vec3f, value: f32, previous: f32) -> Classified {
    return Classified(vec4f(parameters.surface_rgb, OPAQUE_LOG2), gradient_at(position));
}

// Log2 transmittance of one voxel length, for shading rays.
fn log2_transmittance_at(position: vec3f) -> f32 {
    return select(0.0, OPAQUE_LOG2, value_at(position) >= parameters.isovalue);
}
