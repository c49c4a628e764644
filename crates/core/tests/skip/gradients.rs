//! Gradient maps against differences of voxels, and against fields whose gradients are known.

use crate::scene::{Scene, block_sizes, depths, methods, numbers, scenes};
use glam::DVec3;
use proptest::prelude::*;
use wheatstone_core::gradient_map::{GradientDepth, GradientMap};
use wheatstone_core::scene::GradientMethod;
use wheatstone_core::skip::BlockRanges;
use wheatstone_core::volume::{Grid, StorageKind, StoredVoxels, Volume, Voxels};

/// Gradient magnitude at a voxel from the formulas, stored units per voxel length.
fn magnitude(scene: &Scene, method: GradientMethod, voxel: [usize; 3]) -> f64 {
    let dims = scene.dims();
    let at = |offset: [isize; 3]| {
        let [x, y, z] = [0, 1, 2]
            .map(|axis| (voxel[axis] as isize + offset[axis]).clamp(0, dims[axis] as isize - 1) as usize);
        f64::from(scene.stored[x + dims[0] * (y + dims[1] * z)])
    };
    let per_voxel = match method {
        GradientMethod::CentralDifferences => {
            DVec3::new(
                at([1, 0, 0]) - at([-1, 0, 0]),
                at([0, 1, 0]) - at([0, -1, 0]),
                at([0, 0, 1]) - at([0, 0, -1]),
            ) / 2.0
        }
        GradientMethod::Tetrahedron => {
            let corners = [[1, -1, -1], [-1, -1, 1], [-1, 1, -1], [1, 1, 1]];
            let weighted = |c: [isize; 3]| DVec3::from(c.map(|c| c as f64)) * at(c);
            corners.into_iter().map(weighted).sum::<DVec3>() / 4.0
        }
    };
    let grid = scene.volume.grid();
    (per_voxel / (grid.spacing_mm() / grid.voxel_length_mm())).length()
}

proptest! {
    #[test]
    fn magnitudes_equal_the_formulas(scene in scenes(), method in methods(), depth in depths()) {
        let map = GradientMap::new(&scene.volume, scene.kind, method, depth);
        let [width, height, _] = scene.dims();
        let expected: Vec<f64> = (0..scene.stored.len())
            .map(|i| magnitude(&scene, method, [i % width, i / width % height, i / (width * height)]))
            .collect();
        let largest = expected.iter().copied().fold(0.0, f64::max);
        prop_assert!((map.largest() - largest).abs() <= 1e-5 * largest, "{} {}", map.largest(), largest);
        let (per_code, at_zero) = map.normalised_from_code(-1.0);
        prop_assert_eq!(at_zero, 0.0);
        let half_a_code = 0.5 * largest / f64::from(depth.largest_code());
        for (code, expected) in numbers(map.codes()).into_iter().zip(expected) {
            let found = f64::from(code) * per_code;
            prop_assert!((found - expected).abs() <= 1.01 * half_a_code + 1e-5 * largest, "{} {}", found, expected);
        }
        prop_assert_eq!(map.byte_size(), scene.stored.len() * if depth == GradientDepth::Bits8 { 1 } else { 2 });
    }

    #[test]
    fn ranges_of_gradients_equal_those_of_a_volume_of_them(
        scene in scenes(), method in methods(), depth in depths(), block_size in block_sizes()
    ) {
        let map = GradientMap::new(&scene.volume, scene.kind, method, depth);
        let (voxels, kind) = match map.codes().clone() {
            StoredVoxels::U8(v) => (Voxels::U8(v), StorageKind::U8),
            StoredVoxels::U16(v) => (Voxels::U16(v), StorageKind::U16),
            StoredVoxels::F32(_) => unreachable!("codes are whole numbers"),
        };
        let volume = Volume::new(Grid::centred(map.dims(), [1.0; 3]).unwrap(), voxels).unwrap();
        let expected = BlockRanges::of_values(&volume, kind, block_size);
        prop_assert_eq!(BlockRanges::of_gradients(&map, block_size), expected);
    }
}

#[test]
fn a_ramp_has_its_slope() {
    let dims = [9, 8, 20];
    let slope = DVec3::new(3.0, -5.0, 2.0);
    let index = |i: usize| DVec3::new((i % 9) as f64, (i / 9 % 8) as f64, (i / 72) as f64);
    let value = |i: usize| (100.0 + slope.dot(index(i))) as u16;
    let voxels = Voxels::U16((0..dims.iter().product()).map(value).collect());
    let volume = Volume::new(Grid::centred(dims, [0.5, 1.0, 2.0]).unwrap(), voxels).unwrap();
    let expected = DVec3::new(3.0, -2.5, 0.5).length();
    for method in [GradientMethod::CentralDifferences, GradientMethod::Tetrahedron] {
        let map = GradientMap::new(&volume, StorageKind::U16, method, GradientDepth::Bits16);
        let codes = numbers(map.codes());
        for (i, code) in codes.into_iter().enumerate() {
            let is_inside = [i % 9, i / 9 % 8, i / 72].iter().zip(dims).all(|(&c, n)| c > 0 && c < n - 1);
            let found = f64::from(code) * map.normalised_from_code(1.0).0;
            assert!(!is_inside || (found - expected).abs() < 1e-3, "{method:?} {i}: {found} {expected}");
        }
    }
}

#[test]
fn a_flat_volume_has_no_gradient() {
    for voxels in [Voxels::U8(vec![7; 60]), Voxels::F32(vec![-3.5; 60])] {
        let scene = Scene::new([3, 4, 5], voxels);
        let map =
            GradientMap::new(&scene.volume, scene.kind, GradientMethod::Tetrahedron, GradientDepth::Bits8);
        assert_eq!(map.largest(), 0.0);
        assert!(numbers(map.codes()).iter().all(|&code| code == 0.0));
    }
}
