import package::lib::voxels::{is_entry_visible, value_of};

fn is_voxel_visible(voxel: vec3u) -> bool {
    return is_entry_visible(value_of(voxel), 0.0);
}
