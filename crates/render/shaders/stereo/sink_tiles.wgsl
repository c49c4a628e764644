import package::lib::join::{join};

// Segments go into the memory of the workgroup, for a round of slabs.

// Columns of a tile, one for each lane; `TILE_COLUMNS` of the host.
const TILE_COLUMNS: u32 = 32u;

// Slabs of a round: as many as keep the memory below 16 KiB.
const ROUND_SLABS: u32 = 24u;

// Joints of segments, by slab from the nearest and lane.
var<workgroup> segments: array<vec4f, TILE_COLUMNS * ROUND_SLABS>;
// Depths of the first samples, metres.
var<workgroup> segment_depths_m: array<f32, TILE_COLUMNS * ROUND_SLABS>;

struct SegmentPlace {
    lane: u32,
    // The round's nearest slab.
    nearest: i32,
}

fn slot_at(lane: u32, slab_from_nearest: u32) -> u32 {
    return slab_from_nearest * TILE_COLUMNS + lane;
}

// Puts a segment behind what its slot holds. Rounding may put a sample into the slab beside those of its round.
fn put_segment(place: SegmentPlace, slab: i32, segment: vec4f, depth_m: f32) {
    let at = slot_at(place.lane, u32(clamp(place.nearest - slab, 0, i32(ROUND_SLABS) - 1)));
    let held = segments[at];
    segments[at] = join(held, segment);
    segment_depths_m[at] = select(segment_depths_m[at], depth_m, held.a == 0.0);
}

fn empty_slots(lane: u32) {
    for (var slab = 0u; slab < ROUND_SLABS; slab++) {
        segments[slot_at(lane, slab)] = vec4f(0.0);
    }
}
