//! Which way of making a stereo pair is likely to be fastest.
//!
//! The part of the second cast that a derived picture saves (V of SP and VR Eq. 23), measured for composites of 768² on software
//! Vulkan with skipping, by the samples of shading:
//!
//! | | 0 | 4 | 16 | 64 |
//! |---|---|---|---|---|
//! | strips, fast | 0.4–0.6 | 0.7–0.9 | 0.75–0.9 | 0.9 |
//! | tiles | −1.6…−0.1 | | | |
//! | layers | −0.1…0.5 | | | |
//!
//! Repaired strips save about 0.1 to 0.3 less than fast ones: there, strips beat a second cast and the other forms at every
//! shading. Small pictures of small volumes gain less or nothing, but take milliseconds either way.

use crate::pairing::FormName;
use wheatstone_core::scene::Mode;

/// The cheapest way to make a pair on a GPU of one cast; nothing if the mode has no other way than two.
pub(crate) fn cheapest(mode: Mode) -> Option<FormName> {
    matches!(mode, Mode::Composite | Mode::XRay).then_some(FormName::Strips)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_along_rays_are_derived_and_extremes_are_not() {
        assert_eq!(cheapest(Mode::Composite), Some(FormName::Strips));
        assert_eq!(cheapest(Mode::XRay), Some(FormName::Strips));
        assert_eq!(cheapest(Mode::Mip), None);
    }
}
