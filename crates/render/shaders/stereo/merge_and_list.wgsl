import package::lib::merged::{Merged, merged_at};
import package::lib::merged_tile::{TILES, tile_of_invocation};
import package::lib::target::{store};
import package::lib::tile_list::{GROUPS_PER_ROW, tile_list, tile_of_pixel};
import package::lib::view::{view};

// Composites what the strips have left for each derived pixel, and lists the tiles that are better cast: where rays ended that
// they would have needed, and where the picture changes so quickly from column to column that samples half a column off
// show.

// Mean change of slope between columns, over the pixels of a tile and summed over the channels, in parts of their standard
// deviation and `CONTRAST`, above which a tile is cast: DSSIM weighs errors so, too.
const LARGEST_ROUGHNESS: f32 = 0.8;
const CONTRAST: f32 = 0.1;

// Arguments of the cast's indirect dispatch: workgroups along x, y and z.
@group(3) @binding(5) var<storage, read_write> groups: array<atomic<u32>, 3>;

fn merged_in_row(column: i32, row: u32) -> Merged {
    return merged_at(vec2u(u32(clamp(column, 0, i32(view.width) - 1)), row));
}

@compute @workgroup_size(TILES.x, TILES.y)
fn merge_and_list(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let tile = tile_of_invocation(group, local);
    let first = tile.first;
    let end = tile.end;
    var roughness = 0.0;
    var sum = vec4f(0.0);
    var sum_of_squares = vec4f(0.0);
    var is_cut = false;
    for (var y = first.y; y < end.y; y++) {
        var before = merged_in_row(i32(first.x) - 1, y);
        var here = merged_in_row(i32(first.x), y);
        for (var x = first.x; x < end.x; x++) {
            let after = merged_in_row(i32(x) + 1, y);
            store(vec2u(x, y), here.pixel);
            let change = abs(before.pixel.color + after.pixel.color - 2.0 * here.pixel.color);
            roughness += dot(change, vec4f(1.0));
            sum += here.pixel.color;
            sum_of_squares += here.pixel.color * here.pixel.color;
            is_cut |= here.is_cut;
            before = here;
            here = after;
        }
    }
    let count = f32((end.x - first.x) * max(end.y - first.y, 1u));
    let variance = max(sum_of_squares / count - sum * sum / (count * count), vec4f(0.0));
    let deviation = sqrt(dot(variance, vec4f(1.0)));
    if is_cut || roughness / count > LARGEST_ROUGHNESS * (deviation + CONTRAST) {
        let slot = atomicAdd(&tile_list.count, 1u);
        tile_list.tiles[slot] = tile_of_pixel(first);
        atomicMax(&groups[1], slot / GROUPS_PER_ROW + 1u);
    }
}
