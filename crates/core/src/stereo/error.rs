//! Why a pair of views cannot share rays.

use crate::scene::Mode;
use thiserror::Error;

/// Why the picture of one eye cannot be derived from the rays of the other. Two casts always can make the pair.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum StereoError {
    /// A parallel projection: shifts do not depend on depth as they do in perspective.
    #[error("both views must be perspective")]
    Projection,
    /// Pictures of different sizes.
    #[error("pictures of {}×{} and {}×{} pixels: one size is needed", reference[0], reference[1], derived[0], derived[1])]
    Size {
        /// Width and height of the reference picture, pixels.
        reference: [u32; 2],
        /// Width and height of the derived picture, pixels.
        derived: [u32; 2],
    },
    /// Image planes that are not parallel or not level with each other.
    #[error(
        "the eyes are turned against each other by {angle_rad} rad: image planes must be parallel (not toed in)"
    )]
    Orientation {
        /// Angle between the views, radians.
        angle_rad: f64,
    },
    /// One eye is above or before the other.
    #[error(
        "the derived eye is {up_m} m above and {back_m} m behind the reference eye: only sideways is possible"
    )]
    Baseline {
        /// Along view +Y, metres.
        up_m: f64,
        /// Along view +Z, metres.
        back_m: f64,
    },
    /// Rows that do not correspond.
    #[error("vertical tangents {reference:?} and {derived:?} (down, up): must be equal")]
    VerticalTangents {
        /// Of the reference view.
        reference: [f64; 2],
        /// Of the derived view.
        derived: [f64; 2],
    },
    /// Columns of different widths.
    #[error(
        "horizontal extents {reference} and {derived} (right − left tangents): must be equal and above 0"
    )]
    HorizontalExtent {
        /// Of the reference view.
        reference: f64,
        /// Of the derived view.
        derived: f64,
    },
    /// Near or far planes that differ.
    #[error("depth ranges {reference:?} and {derived:?} m: must be equal")]
    DepthRange {
        /// Near and far of the reference view, metres.
        reference: [f64; 2],
        /// Near and far of the derived view, metres.
        derived: [f64; 2],
    },
    /// A mode whose samples do not add up.
    #[error("mode {name}: only composites and X-rays can be derived", name = .0.name())]
    Mode(Mode),
    /// Rays far beyond the picture's edges are needed: the volume comes too near to the eyes, or the windows are far apart.
    #[error("{needed} columns of rays are needed, but at most {most} are cast: move the near plane away")]
    Columns {
        /// Columns that the pair needs.
        needed: usize,
        /// Columns that are cast.
        most: usize,
    },
}
