import package::lib::shear::{shear, slabs_of_square};

// Lists the slabs in which the squares of a view may have something.

// Two words of bits for each square that is derived.
@group(0) @binding(2) var<storage, read_write> listed: array<vec2u>;

@compute @workgroup_size(8, 8)
fn list_slabs(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < shear.squares) {
        listed[id.y * shear.squares.x + id.x] = slabs_of_square(shear.first_square + id.xy);
    }
}
