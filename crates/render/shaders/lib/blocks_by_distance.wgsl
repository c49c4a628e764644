import package::lib::cast_parameters::{parameters};

// Blocks by their distance from those that may contribute (DM sections 3.4 to 3.6): an occupancy map (distances up
// to 1), an isotropic distance map, or one distance map per octant of directions.
@group(1) @binding(4) var skip_map: texture_3d<u32>;

// Blocks to the nearest one that may contribute, in the octant that starts at a slice; 0 or less if this one may.
fn empty_distance(block: vec3f, octant_slice: i32, scalar: f32) -> f32 {
    let distance = textureLoad(skip_map, vec3i(block) + vec3i(0, 0, octant_slice), 0).x;
    return f32(distance) - parameters.skip_margin;
}
