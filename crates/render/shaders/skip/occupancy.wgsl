import package::lib::field::{field_word};
import package::lib::occupy::{block_dims, is_occupied};

// What empty blocks get, where occupied ones get 0; words from a row to the next.
@group(0) @binding(0) var<uniform> empty_and_row: vec4u;
@group(0) @binding(1) var<storage, read_write> field: array<u32>;

@compute @workgroup_size(8, 8)
fn find_occupied(@builtin(global_invocation_id) id: vec3u) {
    let blocks = block_dims();
    let first = 4u * id.x;
    if first >= blocks.x || id.y >= blocks.y {
        return;
    }
    // Bytes after the end of a row are empty.
    var word = 0u;
    for (var i = 0u; i < 4u; i++) {
        let is_empty = first + i >= blocks.x || !is_occupied(vec3u(first + i, id.yz));
        word |= select(0u, empty_and_row.x, is_empty) << (8u * i);
    }
    field[field_word(id, blocks, empty_and_row.y)] = word;
}
