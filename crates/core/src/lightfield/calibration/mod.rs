//! From measurements of a display of projectors to its description and to what remains to be corrected (LF §4, §5).

mod color_table;
mod corrections;
mod fit;
mod geometry_warp;
mod ids;
mod measurements;

pub use color_table::{ColorTable, NotATable};
pub use corrections::{Correction, CorrectionError, Corrections};
pub use fit::{Correspondence, Fit, FitError};
pub use geometry_warp::{GeometryWarp, NotAWarp};
pub use ids::IdError;
pub use measurements::{Calibrated, CalibrationError, MeasuredBeam, MeasuredProjector, Measurements};
