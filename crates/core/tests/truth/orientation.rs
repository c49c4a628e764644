//! The lettered cube seen from six sides, however its voxels are stored: every letter readable and where it belongs.

use crate::scene::*;
use crate::tolerance;
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use wheatstone_core::phantom::Phantom;
use wheatstone_core::scene::{Settings, Shading};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{AnatomicalDirection, Orbit, View, world_from_patient};
use wheatstone_core::volume::{Grid, Volume, Voxels};

/// A face as a viewer in front of it must read it.
struct Face {
    name: char,
    outward_in_patient: DVec3,
    up_in_patient: DVec3,
    letter: [&'static str; 7],
}

const FACES: [Face; 6] = [
    Face {
        name: 'R',
        outward_in_patient: DVec3::X,
        up_in_patient: DVec3::Z,
        letter: ["####.", "#...#", "#...#", "####.", "#.#..", "#..#.", "#...#"],
    },
    Face {
        name: 'L',
        outward_in_patient: DVec3::NEG_X,
        up_in_patient: DVec3::Z,
        letter: ["#....", "#....", "#....", "#....", "#....", "#....", "#####"],
    },
    Face {
        name: 'A',
        outward_in_patient: DVec3::Y,
        up_in_patient: DVec3::Z,
        letter: [".###.", "#...#", "#...#", "#####", "#...#", "#...#", "#...#"],
    },
    Face {
        name: 'P',
        outward_in_patient: DVec3::NEG_Y,
        up_in_patient: DVec3::Z,
        letter: ["####.", "#...#", "#...#", "####.", "#....", "#....", "#...."],
    },
    Face {
        name: 'S',
        outward_in_patient: DVec3::Z,
        up_in_patient: DVec3::Y,
        letter: [".####", "#....", "#....", ".###.", "....#", "....#", "####."],
    },
    Face {
        name: 'I',
        outward_in_patient: DVec3::NEG_Z,
        up_in_patient: DVec3::Y,
        letter: [".###.", "..#..", "..#..", "..#..", "..#..", "..#..", ".###."],
    },
];

/// Side of a letter's dot and height of the letters above the cube's middle, as shares of the phantom.
const DOT: f64 = 0.08;
const LETTER_TOP: f64 = 0.42;

/// Pixels per side of a picture that shows the phantom's cube from edge to edge: six per dot.
const SIDE: u32 = 75;

/// Letters white, the cube black, both solid.
fn settings() -> Settings {
    let opacity = [(0.1, 0.0), (0.35, 0.1), (0.6, 0.1), (0.8, 1.0)];
    let opacity = opacity.map(|(at, alpha)| OpacityPoint { at, alpha }).to_vec();
    let color = [(0.6, 0.0), (0.8, 1.0)].map(|(at, grey)| ColorPoint { at, rgb: [grey; 3] }).to_vec();
    exact_settings(byte_window(), TransferFunction::new(color, opacity).unwrap())
}

/// A view straight at a face from 1 m before the world's origin, one metre high.
fn view_of(face: &Face, world_from_patient: DAffine3) -> View {
    let in_world = |v: DVec3| world_from_patient.transform_vector3(v).normalize_or_zero();
    let size = [SIDE, SIDE];
    look(
        in_world(face.outward_in_patient),
        DVec3::ZERO,
        in_world(face.up_in_patient),
        orthographic(1.0, size),
        size,
    )
}

/// The brightness of the middle of each dot of a centred glyph.
fn dots(volume: &Volume, world_from_patient: DAffine3, view: &View) -> [[f32; 5]; 7] {
    let cast = cast_at(volume, world_from_patient, &settings(), view);
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let at = |offset: f64| ((0.5 + offset * DOT) * f64::from(SIDE)).floor() as u32;
            let (x, y) = (at(column as f64 - 2.0), at(row as f64 - 3.0));
            let block = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
            block.map(|(x, y)| color_at(&cast.image, x, y)[0]).sum::<f32>() / 9.0
        })
    })
}

fn read(dots: &[[f32; 5]; 7]) -> Vec<String> {
    dots.iter().map(|row| row.iter().map(|&level| if level > 0.5 { '#' } else { '.' }).collect()).collect()
}

/// Correlation of dots with a letter, from −1 to 1.
fn correlation(dots: &[[f32; 5]; 7], letter: &[Vec<char>]) -> f64 {
    let pairs: Vec<(f64, f64)> = (0..35)
        .map(|i| (f64::from(dots[i / 5][i % 5]), f64::from(u8::from(letter[i / 5][i % 5] == '#'))))
        .collect();
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>() / 35.0;
    let (a, b) = (mean(&|p| p.0), mean(&|p| p.1));
    let covariance = mean(&|p| (p.0 - a) * (p.1 - b));
    covariance / (mean(&|p| (p.0 - a).powi(2)) * mean(&|p| (p.1 - b).powi(2))).sqrt()
}

fn check_face(face: &Face, volume: &Volume, world_from_patient: DAffine3, case: &str) {
    let view = view_of(face, world_from_patient);
    let dots = dots(volume, world_from_patient, &view);
    assert_eq!(read(&dots), face.letter, "{case}: face {}", face.name);
    let upright: Vec<Vec<char>> = face.letter.iter().map(|row| row.chars().collect()).collect();
    let mirrored: Vec<Vec<char>> = upright.iter().map(|row| row.iter().rev().copied().collect()).collect();
    let upside_down: Vec<Vec<char>> = mirrored.iter().rev().cloned().collect();
    let flipped: Vec<Vec<char>> = upright.iter().rev().cloned().collect();
    let right = correlation(&dots, &upright);
    for wrong in [mirrored, upside_down, flipped].iter().filter(|wrong| **wrong != upright) {
        let wrong = correlation(&dots, wrong);
        assert!(right > wrong + 0.2, "{case}: face {}: {right} right, {wrong} wrong way round", face.name);
    }
    // A dot of the letter's foot is raised: the letters stand 0.42 before the middle, which is at 1 m.
    let column = face.letter[6].find('#').unwrap();
    let pixel = |offset: f64| ((0.5 + offset * DOT) * f64::from(SIDE)).floor() as u32;
    let image = cast_at(volume, world_from_patient, &settings(), &view).image;
    let depth = depth_at_m(&image, pixel(column as f64 - 2.0), pixel(3.0));
    assert!((depth - (1.0 - LETTER_TOP)).abs() < 0.03, "{case}: face {} at {depth} m", face.name);
}

/// 40×44×48 voxels stretched to a cube of 48 mm, so that no two axes can be mistaken.
fn lettered_cube() -> Volume {
    let dims = [40, 44, 48];
    let volume = Phantom::Orientation.volume(dims).unwrap();
    Volume::new(Grid::centred(dims, dims.map(|n| 48.0 / n as f64)).unwrap(), volume.voxels().clone()).unwrap()
}

#[test]
fn each_face_shows_its_letter() {
    let volume = lettered_cube();
    let world = world_from_patient(volume.grid(), AnatomicalDirection::Superior);
    for face in &FACES {
        check_face(face, &volume, world, "as it is");
    }
}

#[test]
fn an_orbit_passes_face_left_back_and_right() {
    let volume = lettered_cube();
    let world = world_from_patient(volume.grid(), AnatomicalDirection::Superior);
    let size = [SIDE, SIDE];
    let quarter = std::f64::consts::FRAC_PI_2;
    let reads = |turns: f64, lift: f64| {
        let orbit = Orbit { azimuth_rad: turns * quarter, elevation_rad: lift * quarter, distance_m: 1.0 };
        read(&dots(&volume, world, &orbit.view(orthographic(1.0, size), size)))
    };
    let letter = |name: char| FACES.iter().find(|face| face.name == name).unwrap().letter;
    for (turns, name) in [(0.0, 'A'), (1.0, 'L'), (2.0, 'P'), (3.0, 'R')] {
        assert_eq!(reads(turns, 0.0), letter(name), "{name} after {turns} quarter turns");
    }
    assert_eq!(reads(0.0, -1.0), letter('I'), "from below");
    // From above the patient's face is at the bottom of the picture, and the letter upside down.
    let upside_down: Vec<String> = letter('S').iter().rev().map(|row| row.chars().rev().collect()).collect();
    assert_eq!(reads(0.0, 1.0), upside_down, "from above");
}

/// The same object with its axes in another order or walked backwards.
fn stored_as(volume: &Volume, order: [usize; 3], backwards: [bool; 3]) -> Volume {
    let from_dims = volume.grid().dims();
    let dims = order.map(|axis| from_dims[axis]);
    let mut linear = DMat3::ZERO;
    let mut start = DVec3::ZERO;
    for (axis, &source) in order.iter().enumerate() {
        linear.col_mut(axis)[source] = if backwards[axis] { -1.0 } else { 1.0 };
        start[source] += if backwards[axis] { (dims[axis] - 1) as f64 } else { 0.0 };
    }
    let source_from_index = DAffine3::from_mat3_translation(linear, start);
    let voxels = (0..volume.voxels().len())
        .map(|i| {
            let index = [i % dims[0], i / dims[0] % dims[1], i / (dims[0] * dims[1])].map(|n| n as f64);
            let source =
                source_from_index.transform_point3(DVec3::from(index)).to_array().map(|n| n as usize);
            volume.voxels().value(source[0] + from_dims[0] * (source[1] + from_dims[1] * source[2])) as u8
        })
        .collect();
    let grid = Grid::new(dims, volume.grid().patient_from_index() * source_from_index).unwrap();
    Volume::new(grid, Voxels::U8(voxels)).unwrap()
}

#[test]
fn all_48_storage_orders_give_one_picture() {
    let volume = lettered_cube();
    let world = world_from_patient(volume.grid(), AnatomicalDirection::Superior);
    let size = [48, 40];
    let eye = DVec3::new(0.9, 0.7, 1.1);
    let view = look(eye, DVec3::ZERO, DVec3::Y, perspective(0.9, size), size);
    let lit = Settings { shading: Shading::Phong, ..settings() };
    let expected = cast_at(&volume, world, &lit, &view);
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for flips in 0..8 {
            let backwards = [flips & 1 != 0, flips & 2 != 0, flips & 4 != 0];
            let stored = stored_as(&volume, order, backwards);
            let stored_world = world_from_patient(stored.grid(), AnatomicalDirection::Superior);
            let found = difference(&expected, &cast_at(&stored, stored_world, &lit, &view));
            let case = format!("{order:?} {backwards:?} {}", stored.grid().orientation_letters());
            assert!(
                found.dssim() < tolerance::STORAGE_ORDER_DSSIM && found.max_abs < 0.02,
                "{case}: {found:?}"
            );
        }
    }
}

#[test]
fn faces_are_readable_in_the_worst_storage_orders() {
    let volume = lettered_cube();
    for (order, backwards) in [
        ([0, 1, 2], [true, true, false]),
        ([2, 0, 1], [false, false, true]),
        ([1, 0, 2], [false, false, false]),
        ([2, 1, 0], [true, true, true]),
    ] {
        let stored = stored_as(&volume, order, backwards);
        let world = world_from_patient(stored.grid(), AnatomicalDirection::Superior);
        for face in &FACES {
            check_face(face, &stored, world, &stored.grid().orientation_letters());
        }
    }
}

/// Voxels on a lattice that is turned against the patient, and left-handed: the letters stay where the patient is.
#[test]
fn an_oblique_lattice_shows_the_same_letters() {
    const FINE: usize = 100;
    let fine = Phantom::Orientation.cube(FINE).unwrap();
    let rotation = DMat3::from_quat(DQuat::from_euler(EulerRot::XYZ, 0.35, -0.5, 0.9));
    // 80 voxels of 1.8 mm reach beyond the corners of the 84 mm that the letters span, at any turn.
    let (count, spacing_mm) = (80, 1.8);
    let linear = rotation * DMat3::from_diagonal(DVec3::new(spacing_mm, -spacing_mm, spacing_mm));
    let middle = DVec3::splat(0.5 * (count - 1) as f64);
    let patient_from_index = DAffine3::from_mat3_translation(linear, -(linear * middle));
    let voxels = (0..count * count * count)
        .map(|i| {
            let index = [i % count, i / count % count, i / (count * count)].map(|n| n as f64);
            let patient_mm = patient_from_index.transform_point3(DVec3::from(index));
            let nearest = (patient_mm + 0.5 * FINE as f64).floor();
            let is_in = nearest.cmpge(DVec3::ZERO).all() && nearest.cmplt(DVec3::splat(FINE as f64)).all();
            let [x, y, z] = nearest.to_array().map(|n| n as usize);
            if is_in { fine.voxels().value(x + FINE * (y + FINE * z)) as u8 } else { 0 }
        })
        .collect();
    let grid = Grid::new([count; 3], patient_from_index).unwrap();
    let volume = Volume::new(grid, Voxels::U8(voxels)).unwrap();
    // The placement of the unturned phantom: 100 mm are 1 m.
    let world = world_from_patient(fine.grid(), AnatomicalDirection::Superior);
    for face in &FACES {
        check_face(face, &volume, world, "oblique");
    }
}
