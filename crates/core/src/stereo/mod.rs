//! The geometry of a stereo pair: where what one eye sees lies in the other eye's picture.
//!
//! After Buchacher & Erdt 2017 (SP) and Buchacher's thesis (VR §4). One eye's rays, the **reference** eye's, are cast; the
//! **derived** eye's picture is made of their samples. A sample keeps its row and moves along it by an amount that depends
//! on its depth alone, so depths fall into [`Slabs`] of equal shift.

mod epipolar;
mod error;
mod slab_range;
mod slabs;

pub use epipolar::Epipolar;
pub use error::StereoError;
pub use slab_range::SlabRange;
pub use slabs::Slabs;
