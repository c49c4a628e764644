//! The voxel grid: dimensions and the affine map into patient space.

use glam::{DAffine3, DMat3, DVec3, Vec3};
use thiserror::Error;

/// Most voxel lengths from one corner of a volume to another. More of them would take rays millions of samples of voxels that are a
/// million times as long as wide; those that scanners make hold thousands.
pub const MOST_VOXEL_LENGTHS: f64 = 65_536.0;

/// The ways from corner to corner through a volume, texture space.
pub(crate) const DIAGONALS: [Vec3; 4] =
    [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(1.0, 1.0, -1.0)];

/// Dimensions and place of a voxel grid.
///
/// Three spaces meet here (see `ARCHITECTURE.md`): **index** space, where voxel (i, j, k) has its *centre* at
/// (i, j, k), as files define it; **voxel** space, where it covers [i, i+1) and has its centre at i + ½;
/// **patient** space, RAS+ in millimetres.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    dims: [usize; 3],
    patient_from_index: DAffine3,
}

/// Why dimensions and a matrix do not make a grid.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GridError {
    /// A dimension is zero.
    #[error("dimensions {}×{}×{}: each must be at least 1", .0[0], .0[1], .0[2])]
    EmptyDimension([usize; 3]),
    /// The product of the dimensions does not fit the address space.
    #[error("dimensions {}×{}×{} hold more voxels than can be addressed", .0[0], .0[1], .0[2])]
    TooManyVoxels([usize; 3]),
    /// The index-to-patient matrix is singular or not finite.
    #[error("index-to-patient matrix cannot be inverted: {0}")]
    NotInvertible(DAffine3),
}

impl Grid {
    /// A grid from its dimensions and the file's index-to-patient matrix (RAS+, mm; index = voxel centre).
    ///
    /// # Errors
    /// Empty or unaddressable dimensions, and matrices that cannot be inverted.
    pub fn new(dims: [usize; 3], patient_from_index: DAffine3) -> Result<Self, GridError> {
        if dims.contains(&0) {
            return Err(GridError::EmptyDimension(dims));
        }
        let count = dims.iter().try_fold(1_usize, |product, &d| product.checked_mul(d));
        if count.is_none_or(|count| count > isize::MAX as usize) {
            return Err(GridError::TooManyVoxels(dims));
        }
        let linear = patient_from_index.matrix3;
        let lengths = DVec3::new(linear.x_axis.length(), linear.y_axis.length(), linear.z_axis.length());
        let unit_determinant = (linear * DMat3::from_diagonal(lengths.recip())).determinant();
        let ok = patient_from_index.is_finite()
            && lengths.min_element() > 1e-9
            && lengths.max_element() < 1e9
            && patient_from_index.translation.abs().max_element() < 1e12
            && unit_determinant.abs() > 1e-6;
        if !ok {
            return Err(GridError::NotInvertible(patient_from_index));
        }
        Ok(Self { dims, patient_from_index })
    }

    /// An axis-aligned grid centred on the patient origin, index axes along R, A, S.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn centred(dims: [usize; 3], spacing_mm: [f64; 3]) -> Result<Self, GridError> {
        let spacing = DVec3::from(spacing_mm);
        let last_index = DVec3::new(dims[0] as f64, dims[1] as f64, dims[2] as f64) - DVec3::ONE;
        Self::new(
            dims,
            DAffine3::from_mat3_translation(DMat3::from_diagonal(spacing), -0.5 * spacing * last_index),
        )
    }

    /// As many voxels as given, over the same part of space.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn resampled(&self, dims: [usize; 3]) -> Result<Self, GridError> {
        let voxel_from_resampled = self.dims_vec() / DVec3::from(dims.map(|side| side as f64));
        let patient_from_voxel = self.patient_from_voxel() * DAffine3::from_scale(voxel_from_resampled);
        Self::new(dims, patient_from_voxel * DAffine3::from_translation(DVec3::splat(0.5)))
    }

    /// Number of voxels along each axis, the fastest first.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Dimensions as a vector.
    pub fn dims_vec(&self) -> DVec3 {
        DVec3::new(self.dims[0] as f64, self.dims[1] as f64, self.dims[2] as f64)
    }

    /// Product of the dimensions.
    pub fn voxel_count(&self) -> usize {
        self.dims.iter().product()
    }

    /// Voxel centre (i, j, k) to patient position, RAS+ mm: the file's own matrix.
    pub fn patient_from_index(&self) -> DAffine3 {
        self.patient_from_index
    }

    /// Voxel space (voxel i covers [i, i+1)) to patient space.
    pub fn patient_from_voxel(&self) -> DAffine3 {
        self.patient_from_index * DAffine3::from_translation(DVec3::splat(-0.5))
    }

    /// Texture space (0 to 1 over the whole volume) to patient space.
    pub fn patient_from_texture(&self) -> DAffine3 {
        self.patient_from_voxel() * DAffine3::from_scale(self.dims_vec())
    }

    /// Distance between neighbouring voxel centres along each index axis, mm.
    pub fn spacing_mm(&self) -> DVec3 {
        let linear = self.patient_from_index.matrix3;
        DVec3::new(linear.x_axis.length(), linear.y_axis.length(), linear.z_axis.length())
    }

    /// The unit of length for steps and opacities, mm: the smallest spacing, but so long that the volume's diagonal holds no more than
    /// [`MOST_VOXEL_LENGTHS`].
    pub fn voxel_length_mm(&self) -> f64 {
        self.spacing_mm().min_element().max(self.diagonal_mm() / MOST_VOXEL_LENGTHS)
    }

    /// The longest way through the volume, mm.
    fn diagonal_mm(&self) -> f64 {
        let patient_from_texture = self.patient_from_texture().matrix3;
        DIAGONALS.map(|way| (patient_from_texture * way.as_dvec3()).length()).into_iter().fold(0.0, f64::max)
    }

    /// Edge lengths of the volume, mm.
    pub fn size_mm(&self) -> DVec3 {
        self.spacing_mm() * self.dims_vec()
    }

    /// The nearest anatomical direction of each index axis, such as `LPS` or `RAS`.
    ///
    /// Each axis gets a different letter pair even when the grid is oblique.
    pub fn orientation_letters(&self) -> String {
        let linear = self.patient_from_index.matrix3;
        let direction = DMat3::from_cols(
            linear.x_axis / linear.x_axis.length(),
            linear.y_axis / linear.y_axis.length(),
            linear.z_axis / linear.z_axis.length(),
        );
        let mut letters = [' '; 3];
        let mut free_rows = vec![0, 1, 2];
        let mut free_columns = vec![0, 1, 2];
        while let Some((row, column)) =
            free_rows.iter().flat_map(|&row| free_columns.iter().map(move |&column| (row, column))).max_by(
                |&(r0, c0), &(r1, c1)| direction.col(c0)[r0].abs().total_cmp(&direction.col(c1)[r1].abs()),
            )
        {
            let [negative, positive] = [['L', 'R'], ['P', 'A'], ['I', 'S']][row];
            letters[column] = if direction.col(column)[row] < 0.0 { negative } else { positive };
            free_rows.retain(|&r| r != row);
            free_columns.retain(|&c| c != column);
        }
        letters.iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_follow_flips_and_rotations() {
        let axes = |x: DVec3, y: DVec3, z: DVec3| {
            let matrix = DAffine3::from_mat3(DMat3::from_cols(x, y, z));
            Grid::new([2, 3, 4], matrix).unwrap().orientation_letters()
        };
        assert_eq!(axes(DVec3::X, DVec3::Y, DVec3::Z), "RAS");
        assert_eq!(axes(-DVec3::X, -DVec3::Y, DVec3::Z), "LPS");
        assert_eq!(axes(DVec3::Y, -DVec3::Z, DVec3::X), "AIR");
        let oblique = DVec3::new(0.7, 0.71, 0.05);
        assert_eq!(axes(oblique, DVec3::new(-0.71, 0.7, 0.0), DVec3::Z), "ARS".replace("AR", "AL"));
    }

    #[test]
    fn singular_and_empty_grids_are_refused() {
        let flat = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::X, DVec3::Z));
        assert!(matches!(Grid::new([2, 2, 2], flat), Err(GridError::NotInvertible(_))));
        assert!(matches!(Grid::new([2, 0, 2], DAffine3::IDENTITY), Err(GridError::EmptyDimension(_))));
        let huge = [usize::MAX, 2, 2];
        assert!(matches!(Grid::new(huge, DAffine3::IDENTITY), Err(GridError::TooManyVoxels(_))));
    }

    #[test]
    fn a_voxel_length_is_the_smallest_spacing_unless_rays_would_take_forever() {
        let length = |dims, spacing_mm| Grid::centred(dims, spacing_mm).unwrap().voxel_length_mm();
        for (dims, spacing_mm) in [
            ([512, 512, 300], [0.1, 0.1, 3.0]),
            ([2048, 2048, 2048], [0.1, 1.0, 1.0]),
            ([1, 1, 3000], [0.05, 1.0, 1.0]),
            ([8, 8, 8], [1e-3, 1.0, 5.0]),
        ] {
            assert_eq!(length(dims, spacing_mm), spacing_mm[0]);
        }
        for (dims, spacing_mm) in
            [([8, 8, 8], [1e-6, 1.0, 1e6]), ([8, 8, 8], [1e-3, 1.0, 1e3]), ([1, 1, 70_000], [1.0; 3])]
        {
            let grid = Grid::centred(dims, spacing_mm).unwrap();
            let diagonal_mm = grid.size_mm().length();
            assert!((diagonal_mm / grid.voxel_length_mm() - MOST_VOXEL_LENGTHS).abs() < 1.0, "{grid:?}");
        }
    }

    #[test]
    fn texture_space_spans_the_voxels_not_their_centres() {
        let grid = Grid::new([4, 2, 1], DAffine3::from_scale(DVec3::new(1.0, 2.0, 3.0))).unwrap();
        let corner = grid.patient_from_texture().transform_point3(DVec3::ZERO);
        assert!((corner - DVec3::new(-0.5, -1.0, -1.5)).length() < 1e-12);
        let opposite = grid.patient_from_texture().transform_point3(DVec3::ONE);
        assert!((opposite - DVec3::new(3.5, 3.0, 1.5)).length() < 1e-12);
    }
}
