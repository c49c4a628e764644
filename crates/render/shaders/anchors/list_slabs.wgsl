import package::lib::shear::{anchor_column, shear};
import package::lib::slab_cells::{SLAB_SQUARE, slab_bit, slab_squares};

// Lists the slabs in which the squares of a view may have something.

// Those of the anchor's squares: two words of bits each.
@group(0) @binding(1) var<storage, read> bits: array<vec2u>;
// Those of the squares that are derived.
@group(0) @binding(2) var<storage, read_write> listed: array<vec2u>;

// Bits of the slabs in which a square of the view may have something.
fn slabs_of_square(square: vec2u) -> vec2u {
    let columns = i32(slab_squares(shear.anchor_size).x);
    let first = i32(square.y) * columns;
    var slabs = vec2u(0u);
    for (var slab = 0u; slab < shear.slab_count; slab++) {
        let left = i32(floor(anchor_column(square.x * SLAB_SQUARE, slab)));
        // Eight columns, and the one after.
        let begin = left >> 3u;
        let end = (left + i32(SLAB_SQUARE)) >> 3u;
        var held = vec2u(0u);
        if begin >= 0 && begin < columns {
            held = bits[first + begin];
        }
        if end >= 0 && end < columns {
            held |= bits[first + end];
        }
        slabs |= held & slab_bit(slab);
    }
    return slabs;
}

@compute @workgroup_size(8, 8)
fn list_slabs(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < shear.squares) {
        listed[id.y * shear.squares.x + id.x] = slabs_of_square(shear.first_square + id.xy);
    }
}
