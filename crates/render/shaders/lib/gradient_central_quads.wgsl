import package::lib::cast_parameters::{parameters};
import package::lib::quads::{normalised, quad_at, quad_sample_at};

// The normalised value between two pairs of stored ones.
fn value_between(near: vec2f, far: vec2f, across: f32, along: f32) -> f32 {
    let pair = mix(near, far, across);
    return normalised(mix(pair.x, pair.y, along));
}

// As `gradient_central`, with each voxel that the six samples share read once.
fn gradient_at(position: vec3f) -> vec3f {
    let at = quad_sample_at(position);
    let f = at.fraction;
    let near = quad_at(at.voxel);
    let far = quad_at(at.voxel + vec3i(0, 0, 1));

    let near_left = quad_at(at.voxel + vec3i(-1, 0, 0)).xz;
    let far_left = quad_at(at.voxel + vec3i(-1, 0, 1)).xz;
    let near_right = quad_at(at.voxel + vec3i(2, 0, 0)).xz;
    let far_right = quad_at(at.voxel + vec3i(2, 0, 1)).xz;
    let right = value_between(mix(near.yw, near_right, f.x), mix(far.yw, far_right, f.x), f.z, f.y);
    let left = value_between(mix(near_left, near.xz, f.x), mix(far_left, far.xz, f.x), f.z, f.y);

    let near_below = quad_at(at.voxel + vec3i(0, -1, 0)).xy;
    let far_below = quad_at(at.voxel + vec3i(0, -1, 1)).xy;
    let near_above = quad_at(at.voxel + vec3i(0, 2, 0)).xy;
    let far_above = quad_at(at.voxel + vec3i(0, 2, 1)).xy;
    let above = value_between(mix(near.zw, near_above, f.y), mix(far.zw, far_above, f.y), f.z, f.x);
    let below = value_between(mix(near_below, near.xy, f.y), mix(far_below, far.xy, f.y), f.z, f.x);

    let behind = mix(far, quad_at(at.voxel + vec3i(0, 0, 2)), f.z);
    let before = mix(quad_at(at.voxel + vec3i(0, 0, -1)), near, f.z);
    let per_voxel = 0.5 * vec3f(
        right - left,
        above - below,
        value_between(behind.xy, behind.zw, f.y, f.x) - value_between(before.xy, before.zw, f.y, f.x),
    );
    return (per_voxel * parameters.dims) * parameters.texture_from_metric;
}
