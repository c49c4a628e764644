import package::lib::merged::{merged_at};
import package::lib::target::{store};
import package::lib::view::{BAND_ROWS, first_pixel_of_group, is_outside_piece};

// Composites what the tiles have left for each derived pixel.

@compute @workgroup_size(BAND_ROWS, BAND_ROWS)
fn merge_tiles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let pixel = first_pixel_of_group(group) + local.xy;
    if is_outside_piece(pixel) {
        return;
    }
    store(pixel, merged_at(pixel).pixel);
}
