//! One cast, many views: a few **anchors** among parallel views are cast, and the others are derived from what their rays pass.
//!
//! All views of a quilt look at one plane from places on a line. So what is at one depth moves from view to view by the same number of
//! columns wherever it is in the picture, and never leaves its row. An anchor's rays are cut into slabs of depth, evenly spaced in
//! 1/depth ([`DepthSlabs`]); what is in each is kept by itself, as if nothing were in front ([`SlabPicture`]). A derived view's rays
//! pass the slabs from front to back, each a picture that is moved by its own number of columns and interpolated between two of them.
//!
//! Rays of an anchor end in what is opaque, and behind that nothing is known. Before views are derived, its hidden cells are filled by
//! what the anchors next to it see there ([`fill`]). What neither sees takes the colour of what is furthest back of what hides it.

mod error;
mod fill;
mod plan;
mod shear;
mod slab_picture;
mod slabs;

pub use error::AnchorError;
pub use fill::{MOST_BEHIND, fill};
pub use plan::{Anchor, AnchorPlan, Derived, LEAST_VIEWS_PER_ANCHOR, MOST_SLABS, Source, THICKNESS_PX};
pub use shear::{LEAST_THROUGH, derive};
pub(crate) use slab_picture::SlabWriter;
pub use slab_picture::{CLEAR, Hider, SlabPicture, color_of};
pub use slabs::DepthSlabs;
