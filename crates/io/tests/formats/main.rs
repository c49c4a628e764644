//! Every format through the public API: what is read, what is refused, and what must never crash.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "all of this crate is test code")]

mod build;
mod files;
mod metaimage;
mod nifti;
mod nrrd;
mod orientation;
mod properties;
mod raw;
mod real_files;
