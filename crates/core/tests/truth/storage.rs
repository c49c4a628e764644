//! Values are sampled as precisely as their type holds them, whatever else is in the volume.

use crate::scene::*;
use glam::DVec3;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Grid, Volume, Voxels, Window};

const SIDE: usize = 16;

/// Along z, one pixel a voxel: pixel (x, y) shows the voxels with x and 15 − y.
fn along_z() -> View {
    let size = [SIDE as u32; 2];
    look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(SIDE as f64 * METRES_PER_MM, size), size)
}

/// A fine texture from 0 to 1 without a pattern.
fn texture(index: usize) -> f64 {
    (index as f64 * 0.618_033_988_749).fract()
}

fn volume(voxels: Voxels) -> Volume {
    Volume::new(Grid::centred([SIDE; 3], [1.0; 3]).unwrap(), voxels).unwrap()
}

fn mip(volume: &Volume, window: Window) -> Cast {
    cast(volume, &Settings { mode: Mode::Mip, ..Settings::new(window, grey_transfer()) }, &along_z())
}

/// Largest difference of the grey levels of pixels in the right half, a voxel away from the left one.
fn largest_difference_on_the_right(a: &Cast, b: &Cast) -> f32 {
    let level = |cast: &Cast, (x, y)| color_at(&cast.image, x, y)[0];
    let right = pixels(&along_z()).filter(|&(x, _)| x > SIDE as u32 / 2);
    right.map(|at| (level(a, at) - level(b, at)).abs()).fold(0.0, f32::max)
}

/// A texture in the right half and a fill value in the left one.
fn filled(fill: f32) -> Volume {
    let value = |i: usize| if i % SIDE < SIDE / 2 { fill } else { texture(i) as f32 };
    volume(Voxels::F32((0..SIDE.pow(3)).map(value).collect()))
}

#[test]
fn a_fill_value_far_outside_the_data_costs_no_precision() {
    let plain = mip(&filled(0.0), unit_window());
    let levels: Vec<f32> = pixels(&along_z()).map(|(x, y)| color_at(&plain.image, x, y)[0]).collect();
    assert!(levels.iter().any(|&level| level > 0.99) && levels.iter().filter(|&&l| l > 0.0).count() > 100);
    for fill in [-1024.0, -1e20, -3.4e38, f32::MIN] {
        let found = mip(&filled(fill), unit_window());
        let difference = largest_difference_on_the_right(&plain, &found);
        assert!(difference <= 1e-6, "fill {fill:e}: the data differ by {difference}");
        for (x, y) in pixels(&along_z()).filter(|&(x, _)| x < SIDE as u32 / 2 - 1) {
            assert_eq!(color_at(&found.image, x, y)[0], 0.0, "fill {fill:e} at ({x}, {y})");
        }
    }
}

#[test]
fn small_steps_on_a_large_offset_are_kept() {
    let with_offset = |offset: f64| {
        volume(Voxels::F64((0..SIDE.pow(3)).map(|i| offset + (100.0 * texture(i)).round() / 100.0).collect()))
    };
    let plain = mip(&with_offset(0.0), unit_window());
    for offset in [1e3, -1e6, 1e6, 1e9] {
        let found = mip(&with_offset(offset), Window::new(offset, offset + 1.0).unwrap());
        let difference = largest_difference(&plain, &found);
        // f64 itself has steps of 1e-7 there, and a level of the table is 2.4e-4.
        assert!(difference <= 2.5e-4, "offset {offset:e}: {difference}");
    }
}
