//! Level of detail: what is far away is cast from coarser voxels by longer steps (Weiler et al., "Level-of-detail volume
//! rendering via 3D textures", 2000).
//!
//! A view's depths are cut into [`Slab`]s. Each is cast as a view of its own, of a coarser level of the volume
//! ([`crate::volume::Volume::coarser_levels`]), behind the picture of the nearer ones
//! ([`crate::reference::Caster::cast_behind`]).

mod footprint;
mod slab;

pub use footprint::Footprint;
pub use slab::{LevelOfDetail, Slab};
