import package::lib::pair::{pair};

// As many layers as slabs: no two reference rays of a row that share one reach the same derived pixel (SP Alg. 1).

fn layer_of(column: i32) -> i32 {
    return (column - pair.first_column) % (pair.nearest - pair.furthest + 1);
}
