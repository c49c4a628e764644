import package::lib::view::{view};

// From a column of a picture to the sweep column, and back.
fn mirrored(column: i32) -> i32 {
    return select(column, i32(view.width) - 1 - column, view.pair.is_mirrored == 1u);
}
