import package::lib::accumulate::{finish_ray};
import package::lib::cast_segments::{cast_segments};
import package::lib::join::{join};
import package::lib::mirrored::{mirrored};
import package::lib::ray::{ray_through};
import package::lib::ray_state::{FIRST_HIT_ALPHA};
import package::lib::segment_sink::{ROUND_SLABS, SegmentPlace, TILE_COLUMNS, empty_slots, segment_depths_m, segments, slot_at};
import package::lib::segmented_ray::{start_segments};
import package::lib::strips::{first_reached, partial_at, partial_depths_m, partials, reach};
import package::lib::target::{store};
import package::lib::view::{first_pixel_of_group, view};

// Casts the reference view in tiles of a row: the lanes of a workgroup cast neighbouring columns through some slabs and keep the
// segments in the workgroup's memory, then composite those of each derived pixel and go on to the slabs behind. Every
// partial sum is written, also of rows below the picture.

@compute @workgroup_size(TILE_COLUMNS)
fn cast_tiles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let tile = group.x;
    let row = first_pixel_of_group(group).y + group.z;
    let offset = tile * TILE_COLUMNS + lane;
    let x = mirrored(view.pair.first_column + i32(offset));
    var ray = ray_through(vec2f(f32(x), f32(row)) + 0.5);
    if offset >= view.pair.column_count || row >= view.first_row + view.row_count {
        ray.sample_count = 0u;
    }
    var under_way = start_segments(ray);
    for (var nearest = view.pair.nearest; nearest >= view.pair.furthest; nearest -= i32(ROUND_SLABS)) {
        empty_slots(lane);
        let furthest = max(nearest - i32(ROUND_SLABS) + 1, view.pair.furthest);
        under_way = cast_segments(ray, furthest, SegmentPlace(lane, nearest), under_way);
        workgroupBarrier();
        composite_round(row, tile, lane, nearest);
        workgroupBarrier();
    }
    if ray.sample_count > 0u && x >= 0 && x < i32(view.width) {
        store(vec2u(u32(x), row), finish_ray(ray, under_way.state));
    }
}

// Puts the segments of a round behind what the rounds before have left in the derived columns that both reach. A lane always
// takes the same columns.
fn composite_round(row: u32, tile: u32, lane: u32, nearest: i32) {
    let first = u32(view.pair.nearest - nearest);
    let end = min(first + TILE_COLUMNS + ROUND_SLABS - 1u, reach());
    let columns_before_lane = (first + TILE_COLUMNS - 1u - lane) / TILE_COLUMNS * TILE_COLUMNS;
    for (var reached = columns_before_lane + lane; reached < end; reached += TILE_COLUMNS) {
        let at = partial_at(row, tile, first_reached(tile) + i32(reached));
        let is_held = first > 0u && reached < first + TILE_COLUMNS - 1u;
        var sum = select(vec4f(0.0), partials[at], is_held);
        var depth_m = select(0.0, partial_depths_m[at], is_held);
        // The ray of a column reaches here from the slab that is as far behind the round's nearest as the column is left.
        let from_first = reached - first;
        let last_column = max(i32(from_first) - i32(ROUND_SLABS) + 1, 0);
        var column = i32(min(from_first, TILE_COLUMNS - 1u));
        while column >= last_column {
            let slot = slot_at(u32(column), from_first - u32(column));
            let segment = segments[slot];
            depth_m = select(depth_m, segment_depths_m[slot], sum.a < FIRST_HIT_ALPHA && segment.a > 0.0);
            sum = join(sum, segment);
            column--;
        }
        partials[at] = sum;
        partial_depths_m[at] = depth_m;
    }
}
