import package::lib::first_hits::{HIT_TILE, NOWHERE_M, depth_of};
import package::lib::passage::{Passage, SLABS};

// Where the rays of each tile of a picture may start, by what the last picture saw first: `core::first_hits::Passage`.

// Most tiles along an axis that are looked up for a slab.
const MOST_TILES: u32 = 6u;

// How far beside what was seen something may be, pixels of the last picture.
const MARGIN_PX: f32 = 1.0;

// How far beyond the picture's edge its outermost rays tell what is there, pixels.
const EDGE_PX: f32 = 0.5;

@group(0) @binding(0) var<uniform> passage: Passage;
// Nearness of what each tile of the last picture saw, row by row.
@group(0) @binding(1) var<storage, read> last_nearness: array<u32>;
@group(0) @binding(2) var starts: texture_storage_2d<r32float, write>;

// An edge of the frustum of a tile.
struct Edge {
    origin: vec4f,
    direction: vec4f,
}

// What a part of a frustum covers in the last picture.
struct Cover {
    low: vec2f,
    high: vec2f,
    is_in_front: bool,
}

fn edge_at(corner: vec2u) -> Edge {
    let at = vec3f(1.0, vec2f(corner));
    return Edge(passage.origin * at, passage.direction * at);
}

fn slab_depth_m(index: u32) -> f32 {
    return passage.slab_depths_m[index / 4u][index % 4u];
}

fn with_point(before: Cover, edge: Edge, depth_m: f32) -> Cover {
    let at = edge.origin + depth_m * edge.direction;
    let pixel = at.xy / at.z;
    let is_in_front = at.z > 0.0 && at.w >= passage.last_range_m.x;
    return Cover(min(before.low, pixel), max(before.high, pixel), before.is_in_front && is_in_front);
}

fn with_edge(before: Cover, edge: Edge, depths_m: vec2f) -> Cover {
    return with_point(with_point(before, edge, depths_m.x), edge, depths_m.y);
}

fn tile_at(pixel: vec2f) -> vec2u {
    return vec2u(clamp(pixel, vec2f(0.0), passage.last_size - 1.0)) / HIT_TILE;
}

// The nearest that was seen in what is covered, metres; in front of anything if that is not all in the last picture, or too much of it.
fn nearest_m(cover: Cover) -> f32 {
    let is_within = cover.is_in_front && all(cover.low >= vec2f(-EDGE_PX))
        && all(cover.high <= passage.last_size + EDGE_PX);
    let first = tile_at(cover.low - MARGIN_PX);
    let last = tile_at(cover.high + MARGIN_PX);
    if !is_within || any(last - first >= vec2u(MOST_TILES)) {
        return -NOWHERE_M;
    }
    let columns = (u32(passage.last_size.x) + HIT_TILE - 1u) / HIT_TILE;
    var nearest = 0u;
    for (var row = first.y; row <= last.y; row++) {
        for (var column = first.x; column <= last.x; column++) {
            nearest = max(nearest, last_nearness[row * columns + column]);
        }
    }
    return depth_of(nearest);
}

// The depth within a slab from which on an edge may be behind what was seen at a depth, metres.
fn meets_m(edge: Edge, start_m: f32, limit_m: f32) -> f32 {
    let later_m = select(NOWHERE_M, (limit_m - edge.origin.w) / edge.direction.w, edge.direction.w > 0.0);
    return select(later_m, start_m, edge.origin.w + start_m * edge.direction.w > limit_m);
}

@compute @workgroup_size(8, 8)
fn find_starts(@builtin(global_invocation_id) id: vec3u) {
    let tile = passage.first_tile + id.xy;
    let low = tile * HIT_TILE;
    let high = min(low + HIT_TILE, passage.size);
    let edges = array(edge_at(low), edge_at(vec2u(high.x, low.y)), edge_at(vec2u(low.x, high.y)), edge_at(high));
    var start_m = NOWHERE_M;
    for (var slab = 0u; slab < SLABS && start_m == NOWHERE_M; slab++) {
        let depths_m = vec2f(slab_depth_m(slab), slab_depth_m(slab + 1u));
        var cover = Cover(vec2f(NOWHERE_M), vec2f(-NOWHERE_M), true);
        cover = with_edge(cover, edges[0], depths_m);
        cover = with_edge(cover, edges[1], depths_m);
        cover = with_edge(cover, edges[2], depths_m);
        cover = with_edge(cover, edges[3], depths_m);
        let limit_m = min(nearest_m(cover) - passage.margin_m, passage.last_range_m.y);
        let first = min(meets_m(edges[0], depths_m.x, limit_m), meets_m(edges[1], depths_m.x, limit_m));
        let second = min(meets_m(edges[2], depths_m.x, limit_m), meets_m(edges[3], depths_m.x, limit_m));
        let meets_m = min(first, second);
        start_m = select(NOWHERE_M, meets_m, meets_m < depths_m.y);
    }
    textureStore(starts, tile, vec4f(start_m, 0.0, 0.0, 0.0));
}
