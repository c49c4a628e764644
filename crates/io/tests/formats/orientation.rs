//! The same object, stored in many orientations and formats, must lie at the same place in the patient.

use super::build::{Nifti, load, with_data};
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use wheatstone_io::{Format, Loaded};

const SIZES: [usize; 3] = [3, 4, 5];
const SPACING_MM: DVec3 = DVec3::new(0.5, 1.25, 2.0);
const ORIGIN_MM: DVec3 = DVec3::new(-7.0, 11.0, 3.0);

/// A way to walk through the lattice: the lattice axis behind each index axis, and whether it is walked backwards.
struct Storage {
    order: [usize; 3],
    backwards: [bool; 3],
    dims: [usize; 3],
    /// RAS+ mm.
    patient_from_index: DAffine3,
    data: Vec<u8>,
}

/// Position to the number of the lattice point.
fn code(lattice_from_patient: DAffine3, patient_mm: DVec3) -> u8 {
    let point = lattice_from_patient.transform_point3(patient_mm).round();
    (point.x + 3.0 * point.y + 12.0 * point.z) as u8
}

fn storages(patient_from_lattice: DAffine3) -> Vec<Storage> {
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let mut storages = Vec::new();
    for order in orders {
        for flips in 0..8 {
            let backwards = [flips & 1 != 0, flips & 2 != 0, flips & 4 != 0];
            let dims = order.map(|axis| SIZES[axis]);
            let mut linear = DMat3::ZERO;
            let mut start = DVec3::ZERO;
            for (axis, &lattice_axis) in order.iter().enumerate() {
                linear.col_mut(axis)[lattice_axis] = if backwards[axis] { -1.0 } else { 1.0 };
                start[lattice_axis] = if backwards[axis] { (dims[axis] - 1) as f64 } else { 0.0 };
            }
            let lattice_from_index = DAffine3::from_mat3_translation(linear, start);
            let patient_from_index = patient_from_lattice * lattice_from_index;
            let data = indices(dims)
                .map(|index| code(DAffine3::IDENTITY, lattice_from_index.transform_point3(index)))
                .collect();
            storages.push(Storage { order, backwards, dims, patient_from_index, data });
        }
    }
    storages
}

fn indices(dims: [usize; 3]) -> impl Iterator<Item = DVec3> {
    (0..dims.iter().product()).map(move |i| {
        let (x, y, z) = (i % dims[0], i / dims[0] % dims[1], i / (dims[0] * dims[1]));
        DVec3::new(x as f64, y as f64, z as f64)
    })
}

fn check_everywhere(write: impl Fn(&Storage) -> Loaded) {
    let upright = DAffine3::from_mat3_translation(DMat3::from_diagonal(SPACING_MM), ORIGIN_MM);
    let rotation = DMat3::from_quat(DQuat::from_euler(EulerRot::XYZ, 0.4, -1.1, 2.3));
    let oblique = DAffine3::from_mat3_translation(rotation * DMat3::from_diagonal(SPACING_MM), ORIGIN_MM);
    for patient_from_lattice in [upright, oblique] {
        let lattice_from_patient = patient_from_lattice.inverse();
        for storage in storages(patient_from_lattice) {
            let loaded = write(&storage);
            let grid = loaded.volume.grid();
            let label = format!("{:?} {:?}", storage.order, storage.backwards);
            assert_eq!(grid.dims(), storage.dims, "{label}");
            for (i, index) in indices(storage.dims).enumerate() {
                let patient_mm = grid.patient_from_index().transform_point3(index);
                let expected_mm = storage.patient_from_index.transform_point3(index);
                assert!(patient_mm.distance(expected_mm) < 1e-4, "{label}: {patient_mm} {expected_mm}");
                let value = loaded.volume.voxels().value(i);
                assert_eq!(value, f64::from(code(lattice_from_patient, patient_mm)), "{label}");
            }
        }
    }
}

fn nifti_of(storage: &Storage) -> Nifti {
    Nifti::new(storage.dims.map(|d| d as i64))
}

#[test]
fn nifti_s_form() {
    for is_2 in [false, true] {
        check_everywhere(|storage| {
            let m = storage.patient_from_index;
            let row = |r: usize| [m.x_axis[r], m.y_axis[r], m.z_axis[r], m.translation[r]];
            let header = Nifti {
                is_2,
                s_form_rows: [row(0), row(1), row(2)],
                q_form_code: 1,
                q_offset: [99.0; 3],
                ..nifti_of(storage)
            };
            load(Format::Nifti, &header.file(&storage.data))
        });
    }
}

#[test]
fn nifti_q_form() {
    check_everywhere(|storage| {
        let m = storage.patient_from_index.matrix3;
        let lengths = [m.x_axis.length(), m.y_axis.length(), m.z_axis.length()];
        let handedness = m.determinant().signum();
        let rotation = DMat3::from_cols(
            m.x_axis / lengths[0],
            m.y_axis / lengths[1],
            handedness * m.z_axis / lengths[2],
        );
        let q = DQuat::from_mat3(&rotation);
        let q = if q.w < 0.0 { -q } else { q };
        let header = Nifti {
            s_form_code: 0,
            q_form_code: 1,
            pixdim: [handedness, lengths[0], lengths[1], lengths[2], 1.0, 1.0, 1.0, 1.0],
            quaternion: [q.x, q.y, q.z],
            q_offset: storage.patient_from_index.translation.to_array(),
            ..nifti_of(storage)
        };
        load(Format::Nifti, &header.file(&storage.data))
    });
}

#[test]
fn nrrd_spaces() {
    let spaces = [
        ("right-anterior-superior", DVec3::ONE),
        ("RAS", DVec3::ONE),
        ("left-anterior-superior", DVec3::new(-1.0, 1.0, 1.0)),
        ("left-posterior-superior", DVec3::new(-1.0, -1.0, 1.0)),
        ("LPS", DVec3::new(-1.0, -1.0, 1.0)),
        ("scanner-xyz", DVec3::ONE),
    ];
    for (space, flip) in spaces {
        check_everywhere(|storage| {
            let m = DAffine3::from_scale(flip) * storage.patient_from_index;
            let vector = |v: DVec3| format!("({},{}, {})", v.x, v.y, v.z);
            let header = format!(
                "NRRD0004\ntype: uchar\ndimension: 3\nsizes: {} {} {}\nencoding: raw\nspace: {space}\n\
                 space directions: {} {} {}\nspace origin: {}\n\n",
                storage.dims[0],
                storage.dims[1],
                storage.dims[2],
                vector(m.x_axis),
                vector(m.y_axis),
                vector(m.z_axis),
                vector(m.translation),
            );
            load(Format::Nrrd, &with_data(&header, &storage.data))
        });
    }
}

#[test]
fn metaimage_directions() {
    check_everywhere(|storage| {
        let m = DAffine3::from_scale(DVec3::new(-1.0, -1.0, 1.0)) * storage.patient_from_index;
        let text = |v: DVec3| format!("{} {} {}", v.x, v.y, v.z);
        let lengths = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
        let header = format!(
            "ObjectType = Image\nNDims = 3\nTransformMatrix = {} {} {}\nOffset = {}\n\
             ElementSpacing = {}\nDimSize = {} {} {}\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
            text(m.x_axis / lengths.x),
            text(m.y_axis / lengths.y),
            text(m.z_axis / lengths.z),
            text(m.translation),
            text(lengths),
            storage.dims[0],
            storage.dims[1],
            storage.dims[2],
        );
        load(Format::MetaImage, &with_data(&header, &storage.data))
    });
}
