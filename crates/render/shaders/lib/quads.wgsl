import package::lib::cast_parameters::{parameters};

// A volume whose texels hold four voxels each: (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1), repeated at the faces.
// Software Vulkan reads four neighbours at once sooner than one after the other.
@group(1) @binding(0) var volume: texture_3d<f32>;
@group(1) @binding(1) var trilinear: sampler;

// Where a trilinear sample is: its lowest voxel, and the way from it to the next along each axis.
struct QuadSample {
    voxel: vec3i,
    fraction: vec3f,
}

fn quad_sample_at(position: vec3f) -> QuadSample {
    let along = clamp(position * parameters.dims - 0.5, vec3f(0.0), parameters.dims - 1.0);
    let voxel = vec3i(along);
    return QuadSample(voxel, along - vec3f(voxel));
}

// The four voxels from one on in x and y, clamped to the volume.
fn quad_at(voxel: vec3i) -> vec4f {
    return textureLoad(volume, clamp(voxel, vec3i(0), vec3i(parameters.dims) - 1), 0);
}

// The normalised value of a stored one.
fn normalised(stored: f32) -> f32 {
    return saturate(stored * parameters.value_scale + parameters.value_offset);
}
