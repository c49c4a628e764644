//! Light-field displays: what they are, the views that they need, what they can resolve, and what an eye in front of them sees.
//!
//! Two kinds: arrays of projectors behind a screen that scatters light vertically alone ([`ProjectorArray`], LF), and panels behind
//! slanted lenses that are fed with quilts ([`QuiltDisplay`], [`Lenticular`]).
//!
//! **Display space** has its origin in the middle of the screen, +X right, +Y up, +Z out of the screen towards the viewers, metres.

pub mod anchors;
pub mod calibration;
mod error;
mod fit;
pub mod lenticular;
pub mod observer;
pub mod projectors;
pub mod quilt;
mod resolution;
pub mod simulator;

pub use error::{DisplayError, LONGEST_SIDE_PX, MOST_PIXELS};
pub use lenticular::Lenticular;
pub use projectors::ProjectorArray;
pub use quilt::QuiltDisplay;
pub use resolution::{Coarseness, MOST_LOST, RESOLVED_PIXELS, Resolution, Tried, coarsest_alike};
