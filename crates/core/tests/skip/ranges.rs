//! Block ranges against the voxels that samples in each block read.

use crate::scene::{Scene, block_sizes, scenes};
use proptest::prelude::*;
use wheatstone_core::skip::{BlockGrid, BlockRanges, BlockSize, RangeCodes, SkipError};
use wheatstone_core::volume::{StorageKind, Voxels};

/// Smallest and largest stored number from one voxel before a block to one after it.
fn interval_read(scene: &Scene, grid: &BlockGrid, block: [usize; 3]) -> [f32; 2] {
    let dims = scene.dims();
    let sides = grid.block_size().sides();
    let read = |axis: usize| {
        let first = (block[axis] * sides[axis] as usize) as isize - 1;
        let last = first + sides[axis] as isize + 1;
        (first..=last).map(move |i| i.clamp(0, dims[axis] as isize - 1) as usize)
    };
    let mut interval = [f32::INFINITY, f32::NEG_INFINITY];
    for z in read(2) {
        for y in read(1) {
            for x in read(0) {
                let voxel = scene.stored[x + dims[0] * (y + dims[1] * z)];
                interval = [interval[0].min(voxel), interval[1].max(voxel)];
            }
        }
    }
    interval
}

fn check(scene: &Scene, block_size: BlockSize) {
    let ranges = BlockRanges::of_values(&scene.volume, scene.kind, block_size);
    let (grid, codes) = (ranges.grid(), ranges.codes());
    assert_eq!(ranges.byte_size(), 4 * grid.block_count());
    let [width, height, _] = grid.dims();
    for (index, &[lo, hi]) in ranges.intervals().iter().enumerate() {
        let block = [index % width, index / width % height, index / (width * height)];
        assert_eq!(grid.index(block), index);
        let [smallest, largest] = interval_read(scene, grid, block);
        if scene.kind == StorageKind::F32 {
            let outward = codes.stored_per_code + codes.rounding;
            assert!(codes.lowest(lo) <= smallest && codes.highest(hi) >= largest);
            assert!(codes.lowest(lo) >= smallest - 1.01 * outward - codes.rounding);
            assert!(codes.highest(hi) <= largest + 1.01 * outward + codes.rounding);
        } else {
            assert_eq!([lo, hi].map(f32::from), [smallest, largest], "{:?} {block:?}", scene.dims());
        }
    }
}

proptest! {
    #[test]
    fn ranges_equal_brute_force(scene in scenes(), block_size in block_sizes()) {
        check(&scene, block_size);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn rounding_leaves_no_interval(
        (lo, width) in (-1.0_f32..1.0, prop::sample::select(vec![1e-3_f32, 1.0, 100.0])),
        corners in prop::array::uniform8(any::<u16>()),
        position in prop::array::uniform3(prop_oneof![0.0_f32..1.0, Just(0.0), Just(1.0), Just(1.0_f32.next_down())]),
    ) {
        let scene = Scene::new([2, 1, 1], Voxels::F32(vec![lo, lo + width]));
        let codes = RangeCodes::of_values(&scene.volume, StorageKind::F32);
        let corners = corners.map(|code| codes.stored(code));
        let mix = |a: f32, b: f32, axis: usize| a + (b - a) * position[axis];
        let along_x = |i: usize| mix(corners[i], corners[i + 1], 0);
        let found = mix(mix(along_x(0), along_x(2), 1), mix(along_x(4), along_x(6), 1), 2);
        let [smallest, largest] =
            corners.iter().fold([f32::MAX, f32::MIN], |[lo, hi], &c| [lo.min(c), hi.max(c)]);
        let [lo, hi] = codes.outward([smallest, largest]);
        prop_assert!(codes.lowest(lo) <= found && found <= codes.highest(hi));
    }
}

#[test]
fn volumes_deeper_than_a_task() {
    let dims = [5, 3, 67];
    let scene = Scene::new(dims, Voxels::U8((0..5 * 3 * 67).map(|i| (i * 7919 % 251) as u8).collect()));
    for side in BlockSize::SMALLEST..=BlockSize::LARGEST {
        check(&scene, BlockSize::cube(side).unwrap());
    }
}

#[test]
fn flat_floats_at_the_ends_of_the_range_are_exact() {
    let dims = [8, 2, 2];
    let values = |i: usize| if i % 8 < 4 { -1000.3_f32 } else { 2345.6 };
    let scene = Scene::new(dims, Voxels::F32((0..32).map(values).collect()));
    let ranges = BlockRanges::of_values(&scene.volume, scene.kind, BlockSize::cube(2).unwrap());
    let codes = ranges.codes();
    let [lo, hi] = ranges.intervals()[0];
    assert_eq!([codes.stored(lo), codes.highest(hi)], [-1000.3; 2]);
    let [lo, hi] = ranges.intervals()[3];
    assert_eq!([codes.lowest(lo), codes.stored(hi)], [2345.6; 2]);
}

#[test]
fn blocks_have_sides_from_2_to_16() {
    assert_eq!(BlockSize::cube(1), Err(SkipError::BlockSize([1; 3])));
    assert_eq!(BlockSize::new([2, 16, 17]), Err(SkipError::BlockSize([2, 16, 17])));
    assert_eq!(BlockSize::new([2, 16, 5]).unwrap().sides(), [2, 16, 5]);
}
