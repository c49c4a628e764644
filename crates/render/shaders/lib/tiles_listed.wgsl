import package::lib::target::{BLANK, store};
import package::lib::tile_list::{GROUPS_PER_ROW, TILE, pixel_in_tile, tile_list};

// The pixels of listed tiles: a workgroup takes one tile.

// Invocations of a workgroup.
const LANES: u32 = TILE.x * TILE.y;

const NO_PIXEL = vec2u(0xffffffffu);

// The pixel of a lane; outside the piece where the lane has none.
fn pixel_of_lane(group: vec3u, lane: u32) -> vec2u {
    let slot = group.y * GROUPS_PER_ROW + group.x;
    if slot >= atomicLoad(&tile_list.count) {
        return NO_PIXEL;
    }
    return pixel_in_tile(tile_list.tiles[slot], lane);
}

// Makes a pixel blank whose ray misses: a listed tile may hold something.
fn store_miss(pixel: vec2u) {
    store(pixel, BLANK);
}
