//! Leaping against marching sample by sample.

use glam::Vec3;
use proptest::prelude::*;
use wheatstone_core::skip::{BlockGrid, BlockSize, Occupancy, SkipMap, Structure, steps_out_of};

fn component() -> impl Strategy<Value = f32> {
    prop_oneof![3 => -0.4_f32..0.4, 1 => Just(0.0), 1 => Just(0.125), 1 => Just(-0.25), 1 => Just(1e-30)]
}

/// The block of a position, the nearest one for positions beyond the grid.
fn block_at(grid: &BlockGrid, position: Vec3) -> [usize; 3] {
    [0, 1, 2].map(|axis| (position[axis].max(0.0) as usize).min(grid.dims()[axis] - 1))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_leap_passes_no_occupied_block(
        (dims, occupied) in prop::array::uniform3(1_usize..9).prop_flat_map(|dims| {
            (Just(dims), prop::collection::vec(prop::bool::weighted(0.05), dims.iter().product::<usize>()))
        }),
        start in prop::array::uniform3(0.0_f32..1.0),
        step in prop::array::uniform3(component()),
    ) {
        let grid = BlockGrid::new(dims.map(|side| 3 * side), BlockSize::cube(3).unwrap());
        let occupancy = Occupancy::from_flags(grid, occupied);
        let (start, step) = (Vec3::from(start) * Vec3::from(dims.map(|d| d as f32)), Vec3::from(step));
        prop_assume!(step.abs().max_element() > 1e-3);
        let at = |i: u32| start + step * i as f32;
        let is_in_grid = |p: Vec3| (0..3).all(|axis| (0.0..=dims[axis] as f32).contains(&p[axis]));
        let octant = (0..3).map(|axis| usize::from(step[axis] < 0.0) << axis).sum::<usize>();
        let sample_count = (0..100_000).find(|&i| !is_in_grid(at(i))).unwrap();
        // Within rounding of a face a sample may be taken for one of the block behind it: the halo covers it.
        let is_on_face = |p: Vec3| (0..3).any(|axis| (p[axis] - p[axis].round()).abs() < 1e-4);
        let mut look_ups = Vec::new();
        for structure in [Structure::Occupancy, Structure::Distance, Structure::Anisotropic] {
            let map = SkipMap::new(&occupancy, structure);
            let (mut i, mut taken) = (0, 0);
            while i < sample_count {
                let block = block_at(&grid, at(i));
                let distance = map.at(block, octant);
                let steps = steps_out_of(block, distance.max(1), at(i), step);
                prop_assert!(steps >= 1);
                for passed in i..i.saturating_add(steps).min(sample_count) {
                    let is_occupied = map.at(block_at(&grid, at(passed)), octant) == 0;
                    prop_assert!(is_occupied == (distance == 0) || is_on_face(at(passed)));
                    prop_assert!(distance > 0 || block_at(&grid, at(passed)) == block || is_on_face(at(passed)));
                }
                // The leap is as long as can be: its end is no longer within the distance.
                let end = at(i.saturating_add(steps));
                let is_out = (0..3).any(|axis| {
                    let (low, reach) = (block[axis] as f32, f32::from(distance.max(1)));
                    end[axis] <= low + 1.0 - reach + 1e-4 || end[axis] >= low + reach - 1e-4
                });
                prop_assert!(is_out || i.saturating_add(steps) >= sample_count);
                taken += 1;
                i = i.saturating_add(steps);
            }
            look_ups.push(taken);
        }
        prop_assert!(look_ups[1] <= look_ups[0], "{:?}", look_ups);
    }
}

#[test]
fn steps_at_faces_and_along_axes() {
    let at = |x: f32| Vec3::new(x, 0.5, 0.5);
    let along = |x: f32| Vec3::new(x, 0.0, 0.0);
    assert_eq!(steps_out_of([2, 0, 0], 1, at(2.0), along(0.25)), 4);
    assert_eq!(steps_out_of([2, 0, 0], 1, at(2.9), along(0.25)), 1);
    assert_eq!(steps_out_of([2, 0, 0], 3, at(2.0), along(0.25)), 12);
    assert_eq!(steps_out_of([2, 0, 0], 1, at(2.0), along(-0.25)), 1);
    assert_eq!(steps_out_of([2, 0, 0], 2, at(2.5), along(-0.25)), 6);
    assert_eq!(steps_out_of([2, 0, 0], 1, at(3.0), along(0.25)), 1, "the far face of the last block");
    assert_eq!(steps_out_of([2, 0, 0], 1, at(2.5), Vec3::ZERO), u32::MAX);
}
