import package::lib::quads::{normalised, quad_sample_at, trilinear, volume};

// The normalised value at a texture position. What is read beyond the last slice counts nothing.
fn value_at(position: vec3f) -> f32 {
    let at = quad_sample_at(position);
    let near = textureLoad(volume, at.voxel, 0);
    let far = textureLoad(volume, at.voxel + vec3i(0, 0, 1), 0);
    let quad = mix(near, far, at.fraction.z);
    let pair = mix(quad.xy, quad.zw, at.fraction.y);
    return normalised(mix(pair.x, pair.y, at.fraction.x));
}
