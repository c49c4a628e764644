// Mirror of `uniforms::PairUniform`: what a pair of views has in common. Columns are sweep columns: nearer is further left in the derived picture.

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
    // Loop iterations that shading a sample takes at most.
    iterations_of_shading: u32,
    // Rays that leap in turn, each waiting for the others.
    lockstep_rays: u32,
    // 1 where a dispatch goes on from where the last has stopped.
    is_resuming: u32,
    // 1 where columns count from the right.
    is_mirrored: u32,
}
