import package::lib::mirrored::{mirrored};
import package::lib::strip_bands::{is_reached};
import package::lib::tile_list::{TILE};
import package::lib::view::{BAND_ROWS, view};

// Tiles of the derived picture, one for each invocation.

// Tiles of a workgroup, along x and y; `MERGED_PIXELS` of the host.
const TILES = vec2u(8u, 4u);

struct MergedTile {
    // The first pixel, and the one after the last; no pixels where no ray reaches.
    first: vec2u,
    end: vec2u,
}

fn tile_of_invocation(group: vec3u, local: vec3u) -> MergedTile {
    let first = vec2u(view.first_column, view.first_row) + (group.xy * TILES + local.xy) * TILE;
    var end = min(first + TILE, vec2u(view.width, view.first_row + view.row_count));
    let columns = vec2i(mirrored(i32(first.x) - 1), mirrored(i32(first.x + TILE.x)));
    if !is_reached(first.y / BAND_ROWS, min(columns.x, columns.y), max(columns.x, columns.y)) {
        end.y = first.y;
    }
    return MergedTile(first, end);
}
