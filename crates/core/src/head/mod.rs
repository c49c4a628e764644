//! A head that moves before a display with a fixed refresh, in simulated time.
//!
//! After the simulation of Buchacher's thesis (VR §6.2), with which warps are measured: [`HeadMotion`] knows the pose at any
//! time, [`Display`] when pictures are shown, and [`PosePredictor`] guesses what a tracker's poses lead to. Poses are of the
//! middle between the eyes, the middle view of a [`Rig`](crate::view::Rig).

mod display;
mod error;
mod motion;
mod neck;
mod pose;
mod pose_predictor;

pub use display::Display;
pub use error::HeadError;
pub use motion::HeadMotion;
pub use neck::Neck;
pub use pose::Pose;
pub use pose_predictor::PosePredictor;
