//! What an eye in front of a display sees.
//!
//! All pictures are of the screen, from edge to edge, as [`Eye::view`] pictures a world: what a display shows compares pixel by pixel
//! with what there would be to see.

mod column;
mod eye;
mod lenses;
mod lobe;
mod projectors;
mod sample;

pub use column::SeenView;
pub use eye::{Eye, EyeError};
pub use lenses::NotOfPanel;
pub use lobe::DARK;
pub use projectors::SeenParts;
