//! From points at data values to a transfer function with its window.

use super::TransferReadError;
use wheatstone_core::transfer::{OpacityPoint, TransferFile, transfer_at_values};
use wheatstone_core::volume::Window;

/// Points at data values, each list in any order.
#[derive(Debug, Default)]
pub(super) struct DataPoints {
    pub(super) color: Vec<(f64, [f64; 3])>,
    pub(super) opacity: Vec<(f64, f64)>,
    /// By gradient magnitude, data units per voxel length; empty for none.
    pub(super) gradient_opacity: Vec<(f64, f64)>,
}

/// Normalises the points by the range that colour and opacity span together. `None` if they span nothing.
///
/// The range 0..1 fits any window, so none is recommended then.
pub(super) fn transfer_file(points: DataPoints) -> Result<Option<TransferFile>, TransferReadError> {
    let DataPoints { mut color, mut opacity, mut gradient_opacity } = points;
    color.sort_by(|a, b| a.0.total_cmp(&b.0));
    opacity.sort_by(|a, b| a.0.total_cmp(&b.0));
    gradient_opacity.sort_by(|a, b| a.0.total_cmp(&b.0));
    let values = || color.iter().map(|p| p.0).chain(opacity.iter().map(|p| p.0));
    let (lo, hi) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let Ok(window) = Window::new(lo, hi) else { return Ok(None) };
    let transfer = transfer_at_values(&color, &opacity, window)?;
    let is_one = gradient_opacity.iter().all(|&(_, factor)| factor == 1.0);
    let gradient_points = if is_one { Vec::new() } else { gradient_opacity };
    let gradient_points = gradient_points
        .into_iter()
        .map(|(at, factor)| OpacityPoint { at: (at / (hi - lo)) as f32, alpha: factor as f32 })
        .collect();
    let transfer = transfer.with_gradient_opacity(gradient_points)?;
    let window = (lo != 0.0 || hi != 1.0).then_some(window);
    Ok(Some(TransferFile { transfer, window }))
}
