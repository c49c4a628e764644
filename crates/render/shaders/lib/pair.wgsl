// Mirror of `uniforms::PairUniform`. Columns are sweep columns: nearer is further left in the derived picture.

struct Pair {
    // Disparity times depth, pixels and metres.
    k: f32,
    // Slab m is where k / z is in (m - 1 + offset, m + offset].
    offset: f32,
    // The slab furthest from the eye and the nearest.
    furthest: i32,
    nearest: i32,
    // First column that is cast.
    first_column: i32,
    // Columns that are cast.
    column_count: u32,
    // Columns of a strip.
    width: u32,
    // Strips of a row.
    count: u32,
    // Loop iterations after which an invocation leaves the rest to the next dispatch.
    iteration_limit: u32,
    // Loop iterations that a stretch of samples takes at most, and a read of the skip map.
    iterations_per_stretch: u32,
    iterations_per_leap: u32,
    // 1 where a dispatch goes on from where the last has stopped.
    is_resuming: u32,
    // 1 where columns count from the right.
    is_mirrored: u32,
}

// Not uniform: Mesa 22's software Vulkan crashes on branches and loops that depend on a uniform buffer after the third.
@group(3) @binding(0) var<storage, read> pair: Pair;

// From a column of a picture to the sweep column, and back.
fn mirrored(column: i32, picture_width: u32) -> i32 {
    return select(column, i32(picture_width) - 1 - column, pair.is_mirrored == 1u);
}
