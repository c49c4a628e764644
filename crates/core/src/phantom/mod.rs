//! Analytic volumes: functions of texture coordinates, sampled at voxel centres at any size.
//!
//! Each phantom fills the texture cube from 0 to 1; where the dimensions differ it is stretched with them. Voxels are 1 mm
//! cubes, but for the wedding cakes, which are of one size whatever their voxels, and the volume is centred on the patient's
//! origin, index axes along R, A, S.

mod beetle;
mod marschner_lobb;
mod orientation;
mod present;
mod ramp;
mod shape;
mod shepp_logan;
mod snake;
mod solid_box;
mod sphere;
mod wedding_cake;
mod wire_box;

pub use orientation::{CUBE_VALUE, LETTER_VALUE};
pub use solid_box::{BOX_HI, BOX_LO};
pub use sphere::{SPHERE_EDGE_VOXELS, SPHERE_RADIUS};
pub use wedding_cake::{CAKE_VALUES, WeddingCake};
pub use wire_box::WIRE_HALF_WIDTH_VOXELS;

use wedding_cake::{DEEP_M, FLAT_M};

use crate::volume::{Grid, GridError, Volume, VolumeError, Voxels};
use glam::DVec3;
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// An analytic volume.
///
/// All hold 8-bit voxels (255 is the value 1) but [`Phantom::Ramp`] and [`Phantom::MarschnerLobb`], which hold f32.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phantom {
    /// 1 between [`BOX_LO`] and [`BOX_HI`] along each axis, 0 elsewhere; a voxel that the boundary cuts holds the
    /// fraction of it that lies inside.
    SolidBox,
    /// The twelve edges of the box between [`BOX_LO`] and [`BOX_HI`]: 1 on them, falling linearly to 0 over
    /// [`WIRE_HALF_WIDTH_VOXELS`] voxels.
    WireBox,
    /// 1 inside a centred sphere of radius [`SPHERE_RADIUS`], 0 outside; the value falls linearly over
    /// [`SPHERE_EDGE_VOXELS`] voxels across the surface, which is at the value ½.
    Sphere,
    /// The texture coordinate x: from ½/N to 1 − ½/N at the voxel centres.
    Ramp,
    /// The test signal of Marschner and Lobb 1994 with a frequency of 6 and α = 0.25.
    MarschnerLobb,
    /// The head of Shepp and Logan, in three dimensions and with Toft's contrast.
    SheppLogan,
    /// A gift in nested thin boxes with ribbon and bow: stands in for DM's “present”.
    Present,
    /// A beetle of thin shells in a large empty space: stands in for DM's “stag beetle”.
    Beetle,
    /// A coiled snake with a fine skeleton in faint flesh: stands in for DM's “king snake”.
    Snake,
    /// A cube with a raised letter on each face that names the patient direction it faces: R, L, A, P, S, I.
    ///
    /// Each letter reads upright and unmirrored from outside, with S up on the R, L, A and P faces and A up on the S
    /// and I faces.
    Orientation,
    /// Random dots on three layers, 10 cm before, on and behind the screen of the display of LF: [`WeddingCake::of_paper`].
    WeddingCake,
    /// The same dots with the layers 1 cm apart.
    FlatWeddingCake,
}

/// A name that is no phantom's.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no phantom is called {0:?}; there are {names}", names = Phantom::names())]
pub struct UnknownPhantom(pub String);

/// Why a phantom cannot be sampled at a size.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PhantomError {
    /// A dimension is zero or there are too many voxels.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// There is not enough memory for the voxels.
    #[error("not enough memory for {voxel_count} voxels")]
    Memory {
        /// Voxels asked for.
        voxel_count: usize,
    },
    /// Voxels and grid do not fit.
    #[error(transparent)]
    Volume(#[from] VolumeError),
}

impl Phantom {
    /// Every phantom.
    pub const ALL: &[Self] = &[
        Self::SolidBox,
        Self::WireBox,
        Self::Sphere,
        Self::Ramp,
        Self::MarschnerLobb,
        Self::SheppLogan,
        Self::Present,
        Self::Beetle,
        Self::Snake,
        Self::Orientation,
        Self::WeddingCake,
        Self::FlatWeddingCake,
    ];

    /// Name as written on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::SolidBox => "box",
            Self::WireBox => "wire-box",
            Self::Sphere => "sphere",
            Self::Ramp => "ramp",
            Self::MarschnerLobb => "marschner-lobb",
            Self::SheppLogan => "shepp-logan",
            Self::Present => "present",
            Self::Beetle => "beetle",
            Self::Snake => "snake",
            Self::Orientation => "orientation",
            Self::WeddingCake => "wedding-cake",
            Self::FlatWeddingCake => "flat-wedding-cake",
        }
    }

    /// The phantom with the given number of voxels along each axis. Needs no memory but the result.
    ///
    /// # Errors
    /// [`PhantomError::Grid`] if a dimension is zero or the voxels cannot be addressed, [`PhantomError::Memory`] if
    /// they do not fit the memory.
    pub fn volume(self, dims: [usize; 3]) -> Result<Volume, PhantomError> {
        let grid = Grid::centred(dims, [1.0; 3])?;
        let size = grid.dims_vec();
        let voxels = match self {
            Self::SolidBox => eight_bit(dims, |p| solid_box::value(p, size))?,
            Self::WireBox => eight_bit(dims, |p| wire_box::value(p, size))?,
            Self::Sphere => eight_bit(dims, |p| sphere::value(p, size))?,
            Self::Ramp => Voxels::F32(sample(dims, |p| ramp::value(p) as f32)?),
            Self::MarschnerLobb => Voxels::F32(sample(dims, |p| marschner_lobb::value(p) as f32)?),
            Self::SheppLogan => eight_bit(dims, |p| shepp_logan::value(p, size))?,
            Self::Present => eight_bit(dims, present::value)?,
            Self::Beetle => eight_bit(dims, beetle::value)?,
            Self::Snake => eight_bit(dims, snake::value)?,
            Self::Orientation => eight_bit(dims, orientation::value)?,
            Self::WeddingCake => return WeddingCake::of_paper(DEEP_M).volume(dims),
            Self::FlatWeddingCake => return WeddingCake::of_paper(FLAT_M).volume(dims),
        };
        Ok(Volume::new(grid, voxels)?)
    }

    /// The phantom with the same number of voxels along every axis.
    ///
    /// # Errors
    /// As [`Phantom::volume`].
    pub fn cube(self, size: usize) -> Result<Volume, PhantomError> {
        self.volume([size; 3])
    }

    /// The names of all, in a sentence.
    pub fn names() -> String {
        Self::ALL.iter().map(|phantom| phantom.name()).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Phantom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Phantom {
    type Err = UnknownPhantom;

    fn from_str(name: &str) -> Result<Self, UnknownPhantom> {
        Self::ALL
            .iter()
            .copied()
            .find(|phantom| phantom.name() == name)
            .ok_or_else(|| UnknownPhantom(name.to_owned()))
    }
}

fn eight_bit(dims: [usize; 3], value: impl Fn(DVec3) -> f64 + Sync) -> Result<Voxels, PhantomError> {
    Ok(Voxels::U8(sample(dims, |p| (value(p) * 255.0).round() as u8)?))
}

/// A function of the texture coordinates at every voxel centre, row by row in parallel.
fn sample<T: Send + Copy + Default>(
    dims: [usize; 3],
    at: impl Fn(DVec3) -> T + Sync,
) -> Result<Vec<T>, PhantomError> {
    let voxel_count = dims.iter().product();
    let mut voxels = Vec::new();
    voxels.try_reserve_exact(voxel_count).map_err(|_| PhantomError::Memory { voxel_count })?;
    voxels.resize(voxel_count, T::default());
    let centre = |index: usize, axis: usize| (index as f64 + 0.5) / dims[axis] as f64;
    voxels.par_chunks_mut(dims[0]).enumerate().for_each(|(row, voxels)| {
        let (y, z) = (centre(row % dims[1], 1), centre(row / dims[1], 2));
        for (i, voxel) in voxels.iter_mut().enumerate() {
            *voxel = at(DVec3::new(centre(i, 0), y, z));
        }
    });
    Ok(voxels)
}

#[cfg(test)]
mod tests;
