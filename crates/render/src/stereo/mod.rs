//! The second eye from the rays of the first.

mod error;
mod layers;
mod method;
mod novel_view;
mod pair;
mod repair;
mod splat;
mod strips;
mod tiles;

pub use error::PairError;
pub(crate) use layers::LayerPass;
pub use method::{Form, LayerFormat, PairMethod, Quality};
pub(crate) use novel_view::NovelViewPass;
pub use pair::PairReport;
pub(crate) use repair::{RepairPass, Repairs};
pub(crate) use splat::Splat;
pub(crate) use strips::StripPass;
pub(crate) use tiles::PairTilePass;
