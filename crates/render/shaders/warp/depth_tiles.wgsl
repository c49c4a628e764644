import package::lib::depth_range::{NOTHING, joined};

// Nearest and furthest depth of what is in the layers of each tile: `core::warp::DepthTiles`.

// Side of a tile, pixels.
const SIDE: u32 = 16u;

@group(0) @binding(0) var layers: texture_2d_array<u32>;
// Depths from and to, metres.
@group(0) @binding(1) var tiles: texture_storage_2d<rgba32float, write>;
// First column and row of the pixels that may hold something, and those after the last.
@group(0) @binding(2) var<uniform> drawn: vec4u;

@compute @workgroup_size(8, 8)
fn find_depths(@builtin(global_invocation_id) tile: vec3u) {
    let first = max(tile.xy * SIDE, drawn.xy);
    let end = min((tile.xy + 1u) * SIDE, drawn.zw);
    var depths_m = NOTHING;
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            for (var layer = 0u; layer < textureNumLayers(layers); layer++) {
                let words = textureLoad(layers, vec2u(x, y), layer, 0);
                let own_m = bitcast<vec2f>(words.xy);
                depths_m = select(depths_m, joined(depths_m, own_m), own_m.x < own_m.y);
            }
        }
    }
    textureStore(tiles, tile.xy, vec4f(depths_m, 0.0, 0.0));
}
