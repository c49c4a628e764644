//! Which way of making a stereo pair is likely to be fastest.
//!
//! Costs are per sample of one eye's cast, in units of an unlit sample. A lit sample costs 1 more for each sample of its
//! shading; a second cast costs as much as the first. A derived picture costs the same whatever the shading is: what it takes
//! to composite the samples of the first cast into it.

use crate::pairing::{FormName, QualityName};
use wheatstone_core::scene::Mode;

/// What the choice looks at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairJob {
    /// How samples become a pixel.
    pub(crate) mode: Mode,
    /// Samples that shading one sample takes.
    pub(crate) shading_samples: u32,
    /// Whether rays leap over empty space, so that more of a cast is spent between samples.
    pub(crate) leaps: bool,
    /// How much is done for the derived picture.
    pub(crate) quality: QualityName,
}

/// The cheapest way to make a pair on a GPU of one cast; nothing if two casts are cheaper, or the mode has no other way.
pub(crate) fn cheapest(job: &PairJob) -> Option<FormName> {
    let second_cast = f64::from(1 + job.shading_samples);
    let is_derived = matches!(job.mode, Mode::Composite | Mode::XRay);
    (is_derived && strips(job) < second_cast).then_some(FormName::Strips)
}

/// Cost of a picture derived by strips: what is left of a second cast's without shading.
fn strips(job: &PairJob) -> f64 {
    match (job.quality, job.leaps) {
        (QualityName::Fast, true) => 0.6,
        (QualityName::Fast, false) => 0.5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_along_rays_are_derived_and_extremes_are_not() {
        let job =
            PairJob { mode: Mode::Composite, shading_samples: 0, leaps: true, quality: QualityName::Fast };
        assert_eq!(cheapest(&job), Some(FormName::Strips));
        assert_eq!(cheapest(&PairJob { shading_samples: 24, leaps: false, ..job }), Some(FormName::Strips));
        assert_eq!(cheapest(&PairJob { mode: Mode::XRay, ..job }), Some(FormName::Strips));
        assert_eq!(cheapest(&PairJob { mode: Mode::Mip, ..job }), None);
    }
}
