import package::lib::mirrored::{mirrored};
import package::lib::ray::{ray_through};
import package::lib::skip::{next_run, start_walk};
import package::lib::strip_bands::{WORD_COLUMNS, strip_band_at, strips};
import package::lib::view::{BAND_ROWS, view};

// Lists the columns of each band of rows of which some ray may meet something: a workgroup takes one strip.

var<workgroup> words: array<atomic<u32>, 2>;

@compute @workgroup_size(2u * WORD_COLUMNS)
fn list_columns(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let offset = group.x * view.pair.width + lane;
    let first_row = view.first_row + group.y * BAND_ROWS;
    let end_row = min(first_row + BAND_ROWS, view.first_row + view.row_count);
    let x = f32(mirrored(view.pair.first_column + i32(offset))) + 0.5;
    var is_found = offset >= view.pair.column_count;
    var row = first_row;
    while row < end_row && !is_found {
        let ray = ray_through(vec2f(x, f32(row) + 0.5));
        let run = next_run(start_walk(ray.first, ray.step), 0u, ray.sample_count, 0.0);
        is_found = run.begin < run.end;
        row++;
    }
    if is_found && offset < view.pair.column_count {
        atomicOr(&words[lane / WORD_COLUMNS], 1u << (lane % WORD_COLUMNS));
    }
    workgroupBarrier();
    if lane == 0u {
        let at = strip_band_at(first_row / BAND_ROWS, group.x);
        strips.bands[at].listed = vec2u(atomicLoad(&words[0]), atomicLoad(&words[1]));
        atomicStore(&strips.bands[at].stretches, 0u);
        atomicStore(&strips.bands[at].leaps, 0u);
    }
}
