import package::lib::gradient_uniform::{uniforms, volume};
import package::lib::voxel_gradient::{magnitude_at};

// The largest magnitude so far, as the bits of an f32: those of numbers that are not negative are in the numbers' order.
@group(0) @binding(2) var<storage, read_write> largest: atomic<u32>;

// An invocation looks at one voxel in each slice of the slab.
@compute @workgroup_size(8, 8)
fn find_largest(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(volume).xy) {
        return;
    }
    var found = 0.0;
    for (var i = 0u; i < uniforms.slices; i++) {
        found = max(found, magnitude_at(vec3i(vec3u(id.xy, uniforms.first_slice + i))));
    }
    atomicMax(&largest, bitcast<u32>(found));
}
