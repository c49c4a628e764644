//! One cast, many views: anchors whose rays leave what they pass in slabs of depth, and the views that are derived of these
//! (`core::lightfield::anchors`).

mod cast_anchors;
mod derive_pass;
mod fill_pass;
mod slabs;

pub use cast_anchors::CastAnchors;
pub(crate) use derive_pass::DerivePass;
pub(crate) use fill_pass::FillPass;
pub(crate) use slabs::GpuSlabs;

/// Every kernel of these passes.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<crate::pipeline::KernelFiles<'static>> {
    [derive_pass::kernel_files(), fill_pass::kernel_files()].concat()
}
