import package::lib::blocks::{empty_distance};
import package::lib::cast_parameters::{parameters};
import package::lib::run::{Run};
import package::lib::walk::{Walk, block_at, start_walk, steps_out_of, walk_at};

// Leaps over blocks that cannot contribute.

// Whether most samples of a run are visible.
const RUNS_ARE_DENSE = true;

// More samples than any shading ray has.
const LONGEST_LEAP: f32 = 1024.0;

// The next samples from `begin` on, before `end`, whose block may contribute to a ray that holds `scalar`. The run goes
// on to the end of the block, or for `shortest_run` samples: rays that are cast side by side in lockstep, one of which
// leaves its block sooner than another, would else wait for each other.
fn next_run(walk: Walk, begin: u32, end: u32, scalar: f32) -> Run {
    var i = f32(begin);
    var next = i;
    var map_reads = 0u;
    loop {
        let position = walk_at(walk, i);
        let block = block_at(position);
        let distance = empty_distance(block, walk.octant_slice, scalar);
        next = i + steps_out_of(walk, position, block, max(distance, 1.0));
        map_reads++;
        if distance <= 0.0 {
            next = max(next, i + parameters.shortest_run);
            break;
        }
        i = next;
        if i >= f32(end) {
            break;
        }
    }
    return Run(min(u32(i), end), min(u32(next), end), map_reads);
}

// The sample after one; if that is in an empty block, the first beyond what is empty around it.
fn next_beyond_empty(walk: Walk, sample: u32) -> u32 {
    let position = walk_at(walk, f32(sample));
    let block = block_at(position);
    let distance = empty_distance(block, walk.octant_slice, 0.0);
    let steps = min(steps_out_of(walk, position, block, max(distance, 1.0)), LONGEST_LEAP);
    return sample + select(1u, u32(steps), distance > 0.0);
}

// Whether nothing at a texture position can contribute.
fn is_empty_at(position: vec3f) -> bool {
    return empty_distance(block_at(position * parameters.blocks_per_texture), 0, 0.0) > 0.0;
}
