import package::lib::merged::{merged_at};
import package::lib::merged_tile::{TILES, tile_of_invocation};
import package::lib::target::{store};

// Composites what the strips have left for each derived pixel.

@compute @workgroup_size(TILES.x, TILES.y)
fn merge_strips(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let tile = tile_of_invocation(group, local);
    for (var y = tile.first.y; y < tile.end.y; y++) {
        for (var x = tile.first.x; x < tile.end.x; x++) {
            store(vec2u(x, y), merged_at(vec2u(x, y)).pixel);
        }
    }
}
