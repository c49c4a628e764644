//! Why views cannot be derived from a few of them.

use crate::scene::Mode;
use crate::stereo::StereoError;
use thiserror::Error;

/// Why a few views cannot stand for all. Each can always be cast by itself.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum AnchorError {
    /// No views.
    #[error("there are no views")]
    NoViews,
    /// A mode whose samples do not add up behind each other.
    #[error("mode {name}: only composites can be derived", name = .0.name())]
    Mode(Mode),
    /// Views that do not look side by side, as those of projectors.
    #[error("the views are not side by side: {0}")]
    Views(#[from] StereoError),
    /// More anchors than views, or none.
    #[error("{count} anchors of {views} views: must be 1 to {views}")]
    Count {
        /// Anchors asked for.
        count: u32,
        /// Views.
        views: usize,
    },
    /// Something is too near for rays of two views through it to be alike.
    #[error(
        "the volume is as near to the cameras as {nearest_m:.3} m, but {count} anchors stand for views from {least_m:.3} m on"
    )]
    TooNear {
        /// Nearest depth of the volume, metres.
        nearest_m: f64,
        /// Depth from which on rays are alike, metres.
        least_m: f64,
        /// Anchors.
        count: u32,
    },
    /// So many anchors are needed that casting every view is as fast.
    #[error("{views} views need more than {most} anchors, which does not pay")]
    DoesNotPay {
        /// Views.
        views: usize,
        /// Most anchors that pay.
        most: u32,
    },
}
