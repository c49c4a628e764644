import package::lib::cuts::{HIDING_ALPHA};
import package::lib::merged::{Merged, merged_at};
import package::lib::merged_tile::{TILES, tile_of_invocation};
import package::lib::target::{store};
import package::lib::tile_list::{TILE};
import package::lib::view::{view};

// Composites what the strips have left for each derived pixel, and measures the tiles: what `list_repairs` goes by.

// What is in a tile: nothing; something; something with a gap.
const BLANK_TILE: f32 = 0.0;
const DERIVED_TILE: f32 = 1.0;
const CUT_TILE: f32 = 2.0;

// Of each tile: the sums of its pixels' grey levels and of their squares, the mean square of how much changes from column to
// column change, and what is in it.
@group(3) @binding(5) var measures: texture_storage_2d<rgba32float, write>;

fn merged_in_row(column: i32, row: u32) -> Merged {
    return merged_at(vec2u(u32(clamp(column, 0, i32(view.width) - 1)), row));
}

fn grey_of(merged: Merged) -> f32 {
    return dot(merged.pixel.color.rgb, vec3f(1.0 / 3.0));
}

@compute @workgroup_size(TILES.x, TILES.y)
fn merge_and_measure(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let tile = tile_of_invocation(group, local);
    var sum = 0.0;
    var sum_of_squares = 0.0;
    var bends = 0.0;
    var alpha = 0.0;
    var is_cut = false;
    for (var y = tile.first.y; y < tile.end.y; y++) {
        var before = merged_in_row(i32(tile.first.x) - 1, y);
        var here = merged_in_row(i32(tile.first.x), y);
        for (var x = tile.first.x; x < tile.end.x; x++) {
            let after = merged_in_row(i32(x) + 1, y);
            store(vec2u(x, y), here.pixel);
            let grey = grey_of(here);
            sum += grey;
            sum_of_squares += grey * grey;
            let bend = before.pixel.color.rgb + after.pixel.color.rgb - 2.0 * here.pixel.color.rgb;
            bends += dot(bend, bend) / 3.0;
            alpha += here.pixel.color.a;
            is_cut |= here.is_cut && here.pixel.color.a < HIDING_ALPHA;
            before = here;
            here = after;
        }
    }
    let holds = select(select(BLANK_TILE, DERIVED_TILE, alpha > 0.0), CUT_TILE, is_cut);
    let pixels = f32(TILE.x * TILE.y);
    textureStore(measures, tile.first / TILE, vec4f(sum, sum_of_squares, bends / pixels, holds));
}
