//! Both eyes from the rays of one, ray by ray in the order of Adelson and Hansen 1994 with the segments of He and Kaufman
//! 1996: the truth for the order of compositing.
//!
//! The rays of a row are cast from the last sweep column to the first, each front to back; so the samples that land in a
//! derived pixel come front to back, too.

mod composite_row;
mod derived_row;
mod ray_end;
mod reprojection;
mod splat;
mod sweep;
mod xray_row;

pub use ray_end::RayEnd;
pub use reprojection::Reprojection;
pub use splat::Splat;

use super::aids::Aids;
use super::classify::{PreIntegrated, Value, ValueGradient};
use super::renderer::{Cast, Caster};
use crate::cast::{CastParameters, Classifier};
use crate::scene::Mode;
use crate::stereo::{Epipolar, StereoError};
use composite_row::CompositeRow;
use sweep::Sweep;
use xray_row::XRayRow;

impl Caster {
    /// Casts the reference eye's rays in double precision and derives the other eye's picture from their samples.
    ///
    /// Returns the reference picture, which is that of [`Caster::cast_exactly`], and the derived one. What a reference ray
    /// reads for either counts for its pixel; what rays beyond the reference picture's edges read is in the derived
    /// picture's totals, and no pixel's.
    ///
    /// # Errors
    /// Modes other than composite and X-ray; more columns of rays than can be cast.
    pub fn cast_pair(
        &self,
        parameters: &CastParameters,
        aids: &Aids<'_>,
        epipolar: &Epipolar,
        reprojection: Reprojection,
    ) -> Result<[Cast; 2], StereoError> {
        let context = self.context(parameters, aids);
        let sweep = Sweep::new(parameters, epipolar, reprojection)?;
        match (parameters.mode, parameters.classifier) {
            (Mode::Composite, Classifier::ValueGradient) => {
                Ok(sweep.cast::<CompositeRow<ValueGradient>>(&context))
            }
            (Mode::Composite, Classifier::PreIntegrated) => {
                Ok(sweep.cast::<CompositeRow<PreIntegrated>>(&context))
            }
            (Mode::Composite, _) => Ok(sweep.cast::<CompositeRow<Value>>(&context)),
            (Mode::XRay, _) => Ok(sweep.cast::<XRayRow>(&context)),
            (mode, _) => Err(StereoError::Mode(mode)),
        }
    }
}
