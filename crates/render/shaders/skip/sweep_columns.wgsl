import package::lib::sweep::{sweep, field, line_start};

// One direction of a pass along y or z: with f the distances so far,
//
//     D(y) = min over q <= y of max(y - q, f(q))
//
// in constant time per block. From one block to the next D grows by at most one. It becomes f where f is not larger; else
// it stays D as long as the last q with f(q) <= D is not further away than D, and else becomes D + 1, for which the last q
// with f(q) = D + 1 counts too. (DM Algorithm 3 searches outwards from each block.)
//
// A line is a column of words: four columns of blocks, one after the other, so that one table serves them all. Nothing in
// it is a choice between two paths, both of which software Vulkan would run.

// The last position of each distance. Positions count on from one column to the next: a distance that grew is at most the
// number of blocks so far, so that the positions of columns before are always further away.
var<private> last_at: array<u32, 256>;

@compute @workgroup_size(8, 8)
fn sweep_columns(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= sweep.lines) {
        return;
    }
    var position = 1u;
    for (var shift = 0u; shift < 32u; shift += 8u) {
        var at = line_start(id.xy);
        var distance = 255u;
        // The last position with a distance so far that is not larger.
        var nearest = 0u;
        for (var i = 0u; i < sweep.length; i++) {
            let so_far = field[at] >> shift & 255u;
            last_at[so_far] = position;
            distance = min(distance + select(1u, 0u, nearest + distance >= position), 255u);
            nearest = max(nearest, last_at[distance]);
            nearest = select(nearest, position, so_far <= distance);
            distance = min(distance, so_far);
            let to = at + sweep.to_target;
            field[to] = insertBits(field[to], distance, shift, 8u);
            position++;
            at += sweep.step;
        }
    }
}
