import package::lib::view::{view};

// As many layers as slabs: no two reference rays of a row that share one reach the same derived pixel (SP Alg. 1).

fn layer_of(column: i32) -> i32 {
    return (column - view.pair.first_column) % (view.pair.nearest - view.pair.furthest + 1);
}
