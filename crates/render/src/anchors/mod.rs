//! One cast, many views: anchors whose rays leave what they pass in slabs of depth, and the views that are derived of these
//! (`core::lightfield::anchors`).

mod cast_anchors;
mod derive_pass;
mod slabs;

pub use cast_anchors::CastAnchors;
pub(crate) use derive_pass::DerivePass;
#[cfg(test)]
pub(crate) use derive_pass::kernel_files;
pub(crate) use slabs::GpuSlabs;
