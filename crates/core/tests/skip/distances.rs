//! Distance maps against the distance to every occupied block.

use proptest::prelude::*;
use wheatstone_core::skip::{BlockGrid, BlockSize, OCTANTS, Occupancy, SkipMap, Structure};

fn occupancy(dims: [usize; 3], occupied: Vec<bool>) -> Occupancy {
    let grid = BlockGrid::new(dims.map(|side| 2 * side), BlockSize::cube(2).unwrap());
    assert_eq!(grid.dims(), dims);
    Occupancy::from_flags(grid, occupied)
}

fn blocks(dims: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..dims.iter().product()).map(move |i| [i % dims[0], i / dims[0] % dims[1], i / (dims[0] * dims[1])])
}

/// Distance to the nearest occupied block for which `counts`.
fn nearest(occupied: &[[usize; 3]], from: [usize; 3], counts: impl Fn([isize; 3]) -> bool) -> u8 {
    occupied
        .iter()
        .map(|to| [0, 1, 2].map(|axis| to[axis] as isize - from[axis] as isize))
        .filter(|&offset| counts(offset))
        .map(|offset| offset.map(isize::unsigned_abs).into_iter().max().unwrap().min(255) as u8)
        .min()
        .unwrap_or(255)
}

fn check(occupancy: &Occupancy) {
    let dims = occupancy.grid().dims();
    let occupied: Vec<[usize; 3]> =
        blocks(dims).zip(occupancy.occupied()).filter(|(_, o)| **o).map(|(b, _)| b).collect();
    let [flags, distances, octants] = [Structure::Occupancy, Structure::Distance, Structure::Anisotropic]
        .map(|structure| SkipMap::new(occupancy, structure));
    assert_eq!(flags.byte_size(), occupancy.grid().block_count());
    assert_eq!(distances.byte_size(), occupancy.grid().block_count());
    assert_eq!(octants.byte_size(), OCTANTS * occupancy.grid().block_count());
    for block in blocks(dims) {
        let everywhere = nearest(&occupied, block, |_| true);
        for octant in 0..OCTANTS {
            assert_eq!(flags.at(block, octant), everywhere.min(1), "{dims:?} {block:?}");
            assert_eq!(distances.at(block, octant), everywhere, "{dims:?} {block:?}");
            let ahead = nearest(&occupied, block, |offset| {
                (0..3).all(|axis| if octant >> axis & 1 == 1 { offset[axis] <= 0 } else { offset[axis] >= 0 })
            });
            assert_eq!(octants.at(block, octant), ahead, "{dims:?} {block:?} octant {octant}");
        }
    }
}

proptest! {
    #[test]
    fn maps_equal_brute_force(
        (dims, occupied) in prop::array::uniform3(1_usize..12).prop_flat_map(|dims| {
            let share = prop_oneof![Just(0.002), Just(0.03), Just(0.5)];
            let flags = share.prop_flat_map(move |share| {
                prop::collection::vec(prop::bool::weighted(share), dims.iter().product::<usize>())
            });
            (Just(dims), flags)
        })
    ) {
        check(&occupancy(dims, occupied));
    }
}

#[test]
fn maps_of_nothing_and_of_everything() {
    for dims in [[1, 1, 1], [5, 1, 3], [1, 7, 1], [4, 3, 6]] {
        let count = dims.iter().product();
        check(&occupancy(dims, vec![false; count]));
        check(&occupancy(dims, vec![true; count]));
    }
}

#[test]
fn distances_saturate() {
    for axis in 0..3 {
        let mut dims = [2, 2, 2];
        dims[axis] = 300;
        let mut occupied = vec![false; dims.iter().product()];
        occupied[0] = true;
        check(&occupancy(dims, occupied));
    }
}
