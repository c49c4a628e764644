//! From a NIfTI file with flipped and exchanged axes to a picture: the lettered cube shows the same picture however its
//! voxels are stored. That the picture itself is right is shown by `wheatstone-core`'s orientation tests.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

use glam::{DAffine3, DMat3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::compare;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::{AnatomicalDirection, Frustum, Orbit, Projection, world_from_patient};
use wheatstone_core::volume::{Volume, Window};
use wheatstone_io::{Format, read_bytes};

const SIDE: usize = 40;

/// A NIfTI-1 file of the cube whose index axis a walks along axis `order[a]` of the phantom, backwards where told.
fn nifti(cube: &Volume, order: [usize; 3], backwards: [bool; 3]) -> Vec<u8> {
    let mut linear = DMat3::ZERO;
    let mut start = DVec3::ZERO;
    for axis in 0..3 {
        linear.col_mut(axis)[order[axis]] = if backwards[axis] { -1.0 } else { 1.0 };
        start[order[axis]] += if backwards[axis] { (SIDE - 1) as f64 } else { 0.0 };
    }
    let cube_from_index = DAffine3::from_mat3_translation(linear, start);
    let patient_from_index = cube.grid().patient_from_index() * cube_from_index;

    // Field offsets of the NIfTI-1 header.
    let mut bytes = vec![0_u8; 352];
    bytes[0..4].copy_from_slice(&348_i32.to_le_bytes());
    for (i, size) in [3, SIDE as i16, SIDE as i16, SIDE as i16, 1, 1, 1, 1].into_iter().enumerate() {
        bytes[40 + 2 * i..42 + 2 * i].copy_from_slice(&size.to_le_bytes());
    }
    bytes[70..72].copy_from_slice(&2_i16.to_le_bytes());
    let mut put_f32 =
        |at: usize, value: f64| bytes[at..at + 4].copy_from_slice(&(value as f32).to_le_bytes());
    for i in 0..8 {
        put_f32(76 + 4 * i, 1.0);
    }
    put_f32(108, 352.0);
    let m = patient_from_index;
    for row in 0..3 {
        for (column, vector) in [m.x_axis, m.y_axis, m.z_axis, m.translation].into_iter().enumerate() {
            put_f32(280 + 16 * row + 4 * column, vector[row]);
        }
    }
    bytes[123] = 2;
    bytes[254..256].copy_from_slice(&1_i16.to_le_bytes());
    bytes[344..348].copy_from_slice(b"n+1\0");
    bytes.extend((0..SIDE * SIDE * SIDE).map(|i| {
        let index = [i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)].map(|n| n as f64);
        let [x, y, z] = cube_from_index.transform_point3(DVec3::from(index)).to_array().map(|n| n as usize);
        cube.voxels().value(x + SIDE * (y + SIDE * z)) as u8
    }));
    bytes
}

fn picture(volume: &Volume) -> RgbImage {
    let settings = Settings::new(Window::new(0.0, 255.0).unwrap(), TransferFunction::ramp(0.2, 1.0).unwrap());
    let placement = Placement::new(volume, world_from_patient(volume.grid(), AnatomicalDirection::Superior));
    let size = [48, 48];
    let frustum = Frustum::from_fov(0.8, size).unwrap();
    let orbit = Orbit { azimuth_rad: 0.6, elevation_rad: 0.4, ..Orbit::default() };
    let view = orbit.view(Projection::Perspective(frustum), size);
    let parameters = CastParameters::new(&settings, &placement);
    Caster::new(volume).cast_exactly(&parameters, &Aids::default(), &[view])[0]
        .image
        .over_background([0.0; 3])
}

#[test]
fn a_file_with_turned_axes_shows_the_same_picture() {
    let cube = Phantom::Orientation.cube(SIDE).unwrap();
    let expected = picture(&cube);
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for flips in 0..8 {
            let backwards = [flips & 1 != 0, flips & 2 != 0, flips & 4 != 0];
            let loaded = read_bytes(Format::Nifti, &nifti(&cube, order, backwards), None).unwrap();
            let found = compare(&expected, &picture(&loaded.volume)).unwrap();
            // Rounding alone; a wrong axis is a wholly different picture.
            assert!(found.dssim() < 1e-5, "{order:?} {backwards:?}: {found:?}");
        }
    }
}
