import package::lib::depth_range::{NOTHING, joined};

// Nearest and furthest depth of all tiles: first of those of each column, then of all columns.

@group(0) @binding(0) var tiles: texture_2d<f32>;
@group(0) @binding(1) var range: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn join_columns(@builtin(global_invocation_id) id: vec3u) {
    var depths_m = NOTHING;
    for (var y = 0u; y < textureDimensions(tiles).y; y++) {
        depths_m = joined(depths_m, textureLoad(tiles, vec2u(id.x, y), 0).xy);
    }
    if id.y == 0u {
        textureStore(range, vec2u(id.x, 0u), vec4f(depths_m, 0.0, 0.0));
    }
}

@compute @workgroup_size(8, 8)
fn join_row(@builtin(global_invocation_id) id: vec3u) {
    var depths_m = NOTHING;
    for (var x = 0u; x < textureDimensions(tiles).x; x++) {
        depths_m = joined(depths_m, textureLoad(tiles, vec2u(x, 0u), 0).xy);
    }
    if all(id.xy == vec2u(0u)) {
        textureStore(range, vec2u(0u), vec4f(depths_m, 0.0, 0.0));
    }
}
