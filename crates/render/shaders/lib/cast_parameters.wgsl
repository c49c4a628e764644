// Mirror of `uniforms::CastUniform`.

struct CastParameters {
    // Voxels along each axis.
    dims: vec3f,
    // Samples per voxel length.
    sampling_factor: f32,
    // Low corner of the visible box, texture space.
    box_lo: vec3f,
    // Normalised value of a stored one.
    value_scale: f32,
    // High corner of the visible box, texture space.
    box_hi: vec3f,
    // Normalised value of a stored zero.
    value_offset: f32,
    // Visible half-space in texture space: xyz . p + w >= 0.
    plane: vec4f,
    // Vectors in texture space to metric space (world axes, voxel lengths).
    metric_from_texture: mat3x3f,
    // The inverse.
    texture_from_metric: mat3x3f,
    // Unit vector towards the light of Phong shading, metric space; zero for a headlight.
    to_light: vec3f,
    // Accumulated opacity at which a composited ray ends.
    termination_alpha: f32,
    // Step of a shadow ray, texture space.
    shadow_step: vec3f,
    // Value integral to grey level.
    xray_scale: f32,
    // Colour of the isosurface.
    surface_rgb: vec3f,
    // Normalised value of the isosurface.
    isovalue: f32,
    // Values outside this closed interval are transparent.
    visible: vec2f,
    // Entries of the table along value and along its second coordinate.
    lut_size: vec2u,
    // Blocks of the skip map along each axis of the texture; not whole where the last block is cut off.
    blocks_per_texture: vec3f,
    // Blocks by which a distance is shortened where a sample reaches beyond its block.
    skip_margin: f32,
    // The block furthest from the origin.
    last_block: vec3f,
    // Slices of the skip map per octant of directions; 0 if it holds for all.
    octant_slices: i32,
    // Normalised value of a block range's code, and of code 0.
    code_scale: f32,
    code_offset: f32,
    // Samples that a run is long at least.
    shortest_run: f32,
    // Gradient magnitude of a sampled number of the gradient map.
    magnitude_scale: f32,
    // Directions of directional shading in use.
    direction_count: u32,
    // Layers of emission and absorption that are kept of each ray at most.
    layer_count: u32,
    // What the density is multiplied by where boundaries are enhanced: inside + gain * |gradient|^exponent.
    boundary_inside: f32,
    boundary_gain: f32,
    boundary_exponent: f32,
    // Opacities at which they end; above 1 where there are none.
    layer_thresholds: vec4f,
    // Unit directions, metric space; their absolute components are the light's colour.
    directions: array<vec4f, 64>,
}

@group(0) @binding(0) var<uniform> parameters: CastParameters;
