//! Where the volume stands in the world.

use crate::volume::Grid;
use glam::{DAffine3, DMat3, DVec3};

/// A direction in the patient.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are the anatomical directions")]
pub enum AnatomicalDirection {
    Right,
    Left,
    Anterior,
    Posterior,
    Superior,
    Inferior,
}

impl AnatomicalDirection {
    fn in_patient(self) -> DVec3 {
        match self {
            Self::Right => DVec3::X,
            Self::Left => DVec3::NEG_X,
            Self::Anterior => DVec3::Y,
            Self::Posterior => DVec3::NEG_Y,
            Self::Superior => DVec3::Z,
            Self::Inferior => DVec3::NEG_Z,
        }
    }

    /// The direction that faces an eye at azimuth 0 when this one points up: the patient's face for an upright
    /// patient, else the top of the head.
    fn facing(self) -> Self {
        match self {
            Self::Superior | Self::Inferior => Self::Anterior,
            _ => Self::Superior,
        }
    }
}

/// Puts a volume into the world: centred at the origin, its longest side scaled to 1 m (the DM test camera),
/// with the given patient direction up (+Y) and, for an upright patient, the face towards +Z.
pub fn world_from_patient(grid: &Grid, up: AnatomicalDirection) -> DAffine3 {
    let (up_in_patient, facing) = (up.in_patient(), up.facing().in_patient());
    let right = up_in_patient.cross(facing);
    let rotation = DMat3::from_cols(right, up_in_patient, facing).transpose();
    let centre = grid.patient_from_texture().transform_point3(DVec3::splat(0.5));
    let metres_per_mm = 1.0 / grid.size_mm().max_element();
    DAffine3::from_mat3(rotation * metres_per_mm) * DAffine3::from_translation(-centre)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_upright_patient_faces_the_viewer() {
        let grid = Grid::centred([10, 20, 40], [1.0; 3]).unwrap();
        let world = world_from_patient(&grid, AnatomicalDirection::Superior);
        let head_top = world.transform_point3(DVec3::new(0.0, 0.0, 20.0));
        let nose = world.transform_point3(DVec3::new(0.0, 10.0, 0.0));
        let right_hand = world.transform_point3(DVec3::new(5.0, 0.0, 0.0));
        assert!((head_top - DVec3::new(0.0, 0.5, 0.0)).length() < 1e-12);
        assert!((nose - DVec3::new(0.0, 0.0, 0.25)).length() < 1e-12);
        assert!((right_hand - DVec3::new(-0.125, 0.0, 0.0)).length() < 1e-12);
        assert!(world.matrix3.determinant() > 0.0);
    }

    #[test]
    fn every_direction_gives_a_rotation() {
        use AnatomicalDirection::*;
        let grid = Grid::centred([3, 3, 3], [1.0; 3]).unwrap();
        for up in [Right, Left, Anterior, Posterior, Superior, Inferior] {
            let world = world_from_patient(&grid, up);
            assert!(world.matrix3.determinant() > 0.0, "{up:?}");
            assert!(world.transform_vector3(up.in_patient()).y > 0.3, "{up:?}");
        }
    }
}
