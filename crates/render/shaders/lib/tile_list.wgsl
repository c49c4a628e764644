import package::lib::view::{view};

// Tiles of a picture, numbered row by row, of which some ray may meet something.

// Pixels of a tile: the rays that software Vulkan casts in lockstep.
const TILE = vec2u(4u, 2u);

// Workgroups of a cast along x, one for each tile; `GROUPS_PER_ROW` of the host.
const GROUPS_PER_ROW: u32 = 256u;

struct TileList {
    count: atomic<u32>,
    tiles: array<u32>,
}

@group(2) @binding(3) var<storage, read_write> tile_list: TileList;

fn tiles_per_row() -> u32 {
    return (view.width + TILE.x - 1u) / TILE.x;
}

fn tile_of_pixel(pixel: vec2u) -> u32 {
    return pixel.y / TILE.y * tiles_per_row() + pixel.x / TILE.x;
}

fn pixel_in_tile(tile: u32, lane: u32) -> vec2u {
    let corner = vec2u(tile % tiles_per_row(), tile / tiles_per_row()) * TILE;
    return corner + vec2u(lane % TILE.x, lane / TILE.x);
}
