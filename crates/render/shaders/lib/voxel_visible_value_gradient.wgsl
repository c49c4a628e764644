import package::lib::voxels::{is_entry_visible, uniforms, value_of};

@group(0) @binding(5) var gradients: texture_3d<f32>;

fn is_voxel_visible(voxel: vec3u) -> bool {
    let gradient = textureLoad(gradients, voxel, 0).x * uniforms.gradient_scale;
    return is_entry_visible(value_of(voxel), min(gradient, 1.0));
}
