//! The second eye from the rays of the first.

mod error;
mod method;
mod pair;
mod strips;

pub use error::PairError;
pub use method::{Form, PairMethod, Quality};
pub use pair::PairReport;
pub(crate) use strips::StripPass;
