//! At the display's rate, whatever a view costs: its cells are cast a few per refresh, as many as a budget of time holds.
//!
//! After Buchacher's thesis (VR §5.2, Alg. 4 and 5). No clock and no device: times are passed in, in seconds. A
//! [`CastSchedule`] says which cells to cast before the next refresh and when a picture is complete; what they took is
//! told back to it and predicts ([`Predictor`]) what the next ones take. [`QualityControl`] chooses how coarse views are.

mod batch;
mod cell_costs;
mod cell_grid;
mod error;
mod margin;
mod predictor;
mod quality;
mod quality_control;
mod request;
mod schedule;

pub use batch::Batch;
pub use cell_costs::CellCosts;
pub use cell_grid::CellGrid;
pub use error::BudgetError;
pub use predictor::{Expectation, Predictor};
pub use quality::Quality;
pub use quality_control::QualityControl;
pub use request::ViewRequest;
pub use schedule::CastSchedule;

/// As many cells as a refresh should hold for errors of their predictions to cancel: with costs that vary by ±30 %, casting then gets
/// four fifths or more of the time that an oracle gives it, at 1 % of refreshes missed at most.
pub const CELLS_PER_REFRESH: f64 = 40.0;
