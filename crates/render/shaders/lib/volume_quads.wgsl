import package::lib::quads::{normalised, quad_at, quad_sample_at, trilinear};

// The normalised value at a texture position.
fn value_at(position: vec3f) -> f32 {
    let at = quad_sample_at(position);
    let quad = mix(quad_at(at.voxel), quad_at(at.voxel + vec3i(0, 0, 1)), at.fraction.z);
    let pair = mix(quad.xy, quad.zw, at.fraction.y);
    return normalised(mix(pair.x, pair.y, at.fraction.x));
}
