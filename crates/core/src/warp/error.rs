//! Why a picture cannot be warped.

use crate::image::Image;
use crate::view::View;
use thiserror::Error;

/// Longest side of a picture that is warped, pixels.
pub(super) const LONGEST_SIDE: u32 = 16_384;

/// Why a picture cannot be shown from another pose.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum WarpError {
    /// A parallel projection: no ray of it leads to the plane at infinity but those to one point, and a turn moves each depth
    /// by its own amount.
    #[error("the {0} view is a parallel projection: both must be perspective")]
    Projection(&'static str),
    /// A pose that cannot be inverted, or a window without area.
    #[error("the {0} view needs a finite, invertible pose and a finite window that is not empty")]
    View(&'static str),
    /// A picture without pixels, or too large a one.
    #[error("the {which} view has {}×{} pixels: sides must be 1 to {LONGEST_SIDE}", size[0], size[1])]
    Size {
        /// Which view.
        which: &'static str,
        /// Width and height, pixels.
        size: [u32; 2],
    },
    /// A picture that is not of the view that it is said to show.
    #[error("picture of {}×{} pixels for a view of {}×{}", image[0], image[1], view[0], view[1])]
    Mismatch {
        /// Width and height of the picture, pixels.
        image: [u32; 2],
        /// Width and height of the shown view, pixels.
        view: [u32; 2],
    },
    /// A picture that does not hold one colour and one depth per pixel.
    #[error("picture with {colors} colours and {depths} depths for {pixels} pixels")]
    Pixels {
        /// Colours held.
        colors: usize,
        /// Depths held.
        depths: usize,
        /// Pixels by width and height.
        pixels: usize,
    },
    /// A setting that is no distance.
    #[error("{0} {1} px: must be finite and not negative")]
    Distance(&'static str, f64),
    /// No steps along a novel ray, or too many.
    #[error("{steps} steps along a ray: must be 1 to {most}")]
    Steps {
        /// Steps asked for.
        steps: u32,
        /// Most that are taken.
        most: u32,
    },
    /// A picture that was cast without layers.
    #[error("a picture without layers: only casts that keep them can be warped by volume")]
    NoLayers,
}

impl WarpError {
    /// Refuses a picture that is not of the view.
    pub(super) fn unless_of(image: &Image, view: &View) -> Result<(), Self> {
        Self::unless_of_size([image.width, image.height], view)?;
        let pixels = image.width as usize * image.height as usize;
        let (colors, depths) = (image.color.len(), image.depth_m.len());
        if colors != pixels || depths != pixels {
            return Err(Self::Pixels { colors, depths, pixels });
        }
        Ok(())
    }

    /// Refuses a picture of another size than the view.
    ///
    /// # Errors
    /// [`WarpError::Mismatch`].
    pub fn unless_of_size(image: [u32; 2], view: &View) -> Result<(), Self> {
        if image == view.size { Ok(()) } else { Err(Self::Mismatch { image, view: view.size }) }
    }

    /// Refuses what is no distance.
    pub(super) fn unless_distance(what: &'static str, distance_px: f64) -> Result<(), Self> {
        if distance_px >= 0.0 && distance_px.is_finite() {
            Ok(())
        } else {
            Err(Self::Distance(what, distance_px))
        }
    }
}
