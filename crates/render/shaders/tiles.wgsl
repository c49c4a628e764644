import package::lib::ray::{ray_of_pixel};
import package::lib::skip::{next_run, start_walk};
import package::lib::start::{start_of};
import package::lib::target::{store_blank};
import package::lib::tile_list::{GROUPS_PER_ROW, tile_list, tile_of_pixel};
import package::lib::view::{BAND_ROWS, first_pixel_of_group, is_outside_piece, view};

// Arguments of the cast's indirect dispatch: workgroups along x, y and z.
@group(3) @binding(0) var<storage, read_write> groups: array<atomic<u32>, 3>;
// 1 for each tile that is in the list.
@group(3) @binding(1) var<storage, read_write> is_listed: array<atomic<u32>>;

// Lists the tiles of a piece that the cast has to visit, and finishes the pixels whose rays meet nothing.
@compute @workgroup_size(BAND_ROWS, BAND_ROWS)
fn list_tiles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let pixel = first_pixel_of_group(group) + local.xy;
    if is_outside_piece(pixel) {
        return;
    }
    let ray = ray_of_pixel(pixel);
    if ray.sample_count == 0u {
        return;
    }
    // Samples from `sample_limit` on are not looked at: they count as something.
    let end = min(ray.sample_count, view.sample_limit);
    // A surface may be behind the sample before the first: that one's block counts, too.
    let first = max(start_of(ray, pixel), 1u) - 1u;
    let run = next_run(start_walk(ray.first, ray.step), first, end, 0.0);
    if run.begin >= run.end && end == ray.sample_count {
        store_blank(pixel, run.map_reads);
        return;
    }
    let tile = tile_of_pixel(pixel);
    if atomicExchange(&is_listed[tile], 1u) == 0u {
        let slot = atomicAdd(&tile_list.count, 1u);
        tile_list.tiles[slot] = tile;
        atomicMax(&groups[1], slot / GROUPS_PER_ROW + 1u);
    }
}
