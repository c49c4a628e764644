//! The second eye from the rays of the first.

mod error;
mod strips;

pub use error::PairError;
pub(crate) use strips::StripPass;
