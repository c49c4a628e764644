//! A picture that is cast a few cells per refresh, as many as a budget of time holds: `wheatstone_core::budget` on a device.
//!
//! A [`LiveView`] never waits. Each [`LiveView::refresh`] collects what earlier cells took, by the device's timestamps or, where it
//! has none, by the host's clock, and hands over as many of the next as fit; [`LiveView::front`] is the newest picture that is
//! whole.

mod cells;
mod clock;
mod error;
mod front;
mod host_clock;
mod open_batch;
mod piece;
mod refresh;
mod spares;
mod stamp_clock;
mod under_way;
mod view;
mod wanted;

pub use error::LiveError;
pub use front::Front;
pub use refresh::{Activity, Measured, Refresh};
pub use view::LiveView;
