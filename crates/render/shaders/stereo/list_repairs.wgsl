import package::lib::merged_tile::{TILES};
import package::lib::tile_list::{GROUPS_PER_ROW, TILE, tile_list, tile_of_pixel};
import package::lib::view::{view};

// Lists the tiles of the derived picture that are cast directly: those of which rays have left something out, and of the others
// the worst, as many as it takes for the rest to be as near to their own cast as is asked for.

// Kinds of tiles by the DSSIM that is expected of them; the last is for those that have to be cast.
const RATINGS: u32 = 64u;
const DSSIM_PER_RATING: f32 = 0.0012;

// What tiles that are not blank may be off by in the mean.
const LARGEST_DSSIM: f32 = 0.0065;

// Expected DSSIM of a tile whose colours' second differences along rows have a mean square as large as the contrast around
// it; it grows with the root of that (fitted, `docs/benchmarks/`). Samples between columns are shared by both: what changes evenly
// is right. DSSIM is an error's mean square in parts of the variance around; in parts of the contrast it counts what tiles do
// to the windows beside them, too.
const DSSIM_OF_CONTRAST: f32 = 0.1;

// Half of `(K2 L)^2` of SSIM (Wang et al. 2004).
const LEAST_VARIANCE: f32 = 0.5 * 0.03 * 0.03;

struct RepairPlan {
    // Arguments of the cast's indirect dispatch: workgroups along x, y and z.
    groups: array<atomic<u32>, 3>,
    // The first kind that is cast.
    first_cast: u32,
    // Tiles of each kind.
    tiles: array<atomic<u32>, RATINGS>,
}

@group(3) @binding(0) var<storage, read_write> plan: RepairPlan;
// What `merge_and_measure` has left.
@group(3) @binding(1) var measures: texture_2d<f32>;

// The tile of an invocation, and the tiles that were measured.
struct Place {
    tile: vec2u,
    first: vec2u,
    end: vec2u,
}

fn place_of(group: vec3u, local: vec3u, groups: vec3u) -> Place {
    let first = vec2u(view.first_column, view.first_row) / TILE;
    let rows = (view.first_row + view.row_count + TILE.y - 1u) / TILE.y;
    let columns = (view.width + TILE.x - 1u) / TILE.x;
    let end = min(first + groups.xy * TILES, vec2u(columns, rows));
    return Place(first + group.xy * TILES + local.xy, first, end);
}

fn is_measured(place: Place, tile: vec2u) -> bool {
    return all(tile >= place.first) && all(tile < place.end);
}

// The kind of a tile; RATINGS of a blank one.
fn rating_of(place: Place) -> u32 {
    let measure = textureLoad(measures, place.tile, 0);
    var sums = vec2f(0.0);
    for (var y = 0u; y < 3u; y++) {
        for (var x = 0u; x < 3u; x++) {
            // Left of the first is beyond the last.
            let tile = place.tile + vec2u(x, y) - vec2u(1u);
            let around = textureLoad(measures, min(tile, place.end), 0).rg;
            sums += select(vec2f(0.0), around, is_measured(place, tile));
        }
    }
    let means = sums / f32(9u * TILE.x * TILE.y);
    let variance = max(means.y - means.x * means.x, 0.0);
    let dssim = DSSIM_OF_CONTRAST * sqrt(measure.z * inverseSqrt(variance + LEAST_VARIANCE));
    let rating = min(u32(dssim / DSSIM_PER_RATING), RATINGS - 2u);
    let holds = u32(measure.w);
    return select(select(RATINGS, rating, holds == 1u), RATINGS - 1u, holds == 2u);
}

@compute @workgroup_size(TILES.x, TILES.y)
fn count_ratings(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    let place = place_of(group, local, groups);
    let rating = rating_of(place);
    if is_measured(place, place.tile) && rating < RATINGS {
        atomicAdd(&plan.tiles[rating], 1u);
    }
}

@compute @workgroup_size(1)
fn choose_ratings() {
    var tiles = 0u;
    for (var rating = 0u; rating < RATINGS; rating++) {
        tiles += atomicLoad(&plan.tiles[rating]);
    }
    var dssim_left = LARGEST_DSSIM * f32(tiles);
    var first_cast = 0u;
    while first_cast + 1u < RATINGS {
        let dssim = (f32(first_cast) + 0.5) * DSSIM_PER_RATING;
        dssim_left -= dssim * f32(atomicLoad(&plan.tiles[first_cast]));
        if dssim_left < 0.0 {
            break;
        }
        first_cast++;
    }
    plan.first_cast = first_cast;
}

@compute @workgroup_size(TILES.x, TILES.y)
fn list_repairs(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    let place = place_of(group, local, groups);
    let rating = rating_of(place);
    if is_measured(place, place.tile) && rating >= plan.first_cast && rating < RATINGS {
        let slot = atomicAdd(&tile_list.count, 1u);
        tile_list.tiles[slot] = tile_of_pixel(place.tile * TILE);
        atomicMax(&plan.groups[1], slot / GROUPS_PER_ROW + 1u);
    }
}
