import package::lib::classify::{log2_transmittance_at};
import package::lib::ray::{is_inside};

// Distance of neighbouring samples of shadow and directional rays, voxel lengths.
const SHADING_STEP: f32 = 2.0;

// Log2 transmittance of one voxel length, 0 outside the visible part of the volume.
fn log2_transmittance_inside(position: vec3f) -> f32 {
    if !is_inside(position) {
        return 0.0;
    }
    return log2_transmittance_at(position);
}
