import package::lib::sweep::{sweep, field, line_start};

// Distances along rows, from 0 for occupied blocks and 255 for empty ones (one direction of DM Algorithm 2). A line is a
// row of words, four blocks each.

// Distances of the four blocks of a word, of which the lowest byte comes first; `before` is that of the block before it.
fn count_up(before: u32, word: u32) -> u32 {
    let a = min(before + 1u, word & 255u);
    let b = min(a + 1u, word >> 8u & 255u);
    let c = min(b + 1u, word >> 16u & 255u);
    let d = min(c + 1u, word >> 24u);
    return a | b << 8u | c << 16u | d << 24u;
}

fn reversed(word: u32) -> u32 {
    return word << 24u | (word & 0xff00u) << 8u | (word >> 8u & 0xff00u) | word >> 24u;
}

@compute @workgroup_size(8, 8)
fn sweep_up(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= sweep.lines) {
        return;
    }
    var at = line_start(id.xy);
    var before = 255u;
    for (var i = 0u; i < sweep.length; i++) {
        let word = count_up(before, field[at]);
        before = word >> 24u;
        field[at + sweep.to_target] = word;
        at += sweep.step;
    }
}

@compute @workgroup_size(8, 8)
fn sweep_down(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= sweep.lines) {
        return;
    }
    var at = line_start(id.xy);
    var before = 255u;
    for (var i = 0u; i < sweep.length; i++) {
        let word = count_up(before, reversed(field[at]));
        before = word >> 24u;
        field[at + sweep.to_target] = reversed(word);
        at += sweep.step;
    }
}
