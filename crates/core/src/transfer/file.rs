//! A transfer function together with the window it was made for.

use super::{ColorPoint, OpacityPoint, TransferError, TransferFunction};
use crate::volume::Window;

/// What a transfer-function file or a preset holds: the function, and the window that normalises values for it.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferFile {
    /// Colour and opacity of normalised values.
    pub transfer: TransferFunction,
    /// Values that the function's 0 and 1 stand for; `None` where it fits any window.
    pub window: Option<Window>,
}

/// Distance above the normalised value 0 at which a function that was cut by the window takes up its own course.
const CUT_EDGE: f32 = 1.0 / 2048.0;

/// A transfer function from points at data values, in the unit of the window that normalises them.
///
/// Where the window cuts a segment, the cut gets a point, so that the shape inside the window is kept whatever lies
/// outside. Values below the window are normalised to 0 like the window's own low end; if the function starts
/// transparent, 0 is transparent too, so that air does not take the opacity of the tissue at the window's edge.
///
/// # Errors
/// As [`TransferFunction::new`]; values must be finite and in order.
pub fn transfer_at_values(
    color: &[(f64, [f64; 3])],
    opacity: &[(f64, f64)],
    window: Window,
) -> Result<TransferFunction, TransferError> {
    let color = in_window("color", color, window)?;
    let scalar: Vec<(f64, [f64; 1])> = opacity.iter().map(|&(value, alpha)| (value, [alpha])).collect();
    let mut opacity = in_window("opacity", &scalar, window)?;
    let starts_clear = scalar.first().is_some_and(|(_, alpha)| alpha[0] == 0.0);
    if starts_clear && opacity[0].1[0] > 0.0 {
        opacity.retain(|&(at, _)| at > CUT_EDGE);
        let (course, [alpha]) = (CUT_EDGE, value_at(&scalar, window.denormalise(f64::from(CUT_EDGE))));
        opacity.splice(0..0, [(0.0, [0.0]), (course, [alpha as f32])]);
    }
    TransferFunction::new(
        color.into_iter().map(|(at, rgb)| ColorPoint { at, rgb }).collect(),
        opacity.into_iter().map(|(at, [alpha])| OpacityPoint { at, alpha }).collect(),
    )
}

/// Points as normalised values within [0, 1], with the ends of the window added.
fn in_window<const N: usize>(
    part: &'static str,
    points: &[(f64, [f64; N])],
    window: Window,
) -> Result<Vec<(f32, [f32; N])>, TransferError> {
    if points.is_empty() {
        return Err(TransferError::NoPoints(part));
    }
    let disorder = points
        .iter()
        .enumerate()
        .position(|(i, &(value, _))| !value.is_finite() || (i > 0 && value < points[i - 1].0));
    if let Some(index) = disorder {
        return Err(TransferError::Order { part, index, at: points[index].0 as f32 });
    }
    let narrow = |channels: [f64; N]| channels.map(|c| c as f32);
    let inside = points
        .iter()
        .filter(|&&(value, _)| value > window.lo() && value < window.hi())
        .map(|&(value, channels)| (window.normalise(value) as f32, narrow(channels)));
    let low_end = (0.0, narrow(value_at(points, window.lo())));
    let high_end = (1.0, narrow(value_at(points, window.hi())));
    Ok(std::iter::once(low_end).chain(inside).chain(std::iter::once(high_end)).collect())
}

/// Linear interpolation, constant beyond the ends; at a jump, the point after it counts.
fn value_at<const N: usize>(points: &[(f64, [f64; N])], value: f64) -> [f64; N] {
    let after = points.partition_point(|&(at, _)| at <= value);
    let (below, above) = (points[after.saturating_sub(1)], points[after.min(points.len() - 1)]);
    let width = above.0 - below.0;
    let t = if width > 0.0 { ((value - below.0) / width).clamp(0.0, 1.0) } else { 0.0 };
    std::array::from_fn(|i| below.1[i] + (above.1[i] - below.1[i]) * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COLOR: [(f64, [f64; 3]); 3] = [(-100.0, [0.0; 3]), (0.0, [0.5, 0.2, 0.0]), (300.0, [1.0; 3])];
    const OPACITY: [(f64, f64); 4] = [(-50.0, 0.0), (0.0, 0.2), (100.0, 0.2), (300.0, 0.9)];

    proptest! {
        #[test]
        fn the_shape_does_not_depend_on_the_window(lo in -400.0..250.0_f64, width in 10.0..900.0_f64, t in 0.01..1.0_f64) {
            let window = Window::new(lo, lo + width).unwrap();
            let transfer = transfer_at_values(&COLOR, &OPACITY, window).unwrap();
            let value = window.denormalise(t);
            let scalar = OPACITY.map(|(v, a)| (v, [a]));
            prop_assert!((f64::from(transfer.opacity_at(t as f32)) - value_at(&scalar, value)[0]).abs() < 1e-4);
            let (found, expected) = (transfer.color_at(t as f32), value_at(&COLOR, value));
            prop_assert!((0..3).all(|c| (f64::from(found[c]) - expected[c]).abs() < 1e-4));
        }
    }

    #[test]
    fn values_below_the_window_stay_clear() {
        let transfer = transfer_at_values(&COLOR, &OPACITY, Window::new(50.0, 250.0).unwrap()).unwrap();
        assert_eq!(transfer.opacity_at(0.0), 0.0);
        assert!((transfer.opacity_at(0.001) - 0.2).abs() < 1e-3);
    }

    #[test]
    fn a_window_beside_the_points_takes_their_end() {
        let above = transfer_at_values(&COLOR, &OPACITY, Window::new(1000.0, 2000.0).unwrap()).unwrap();
        assert!((above.opacity_at(0.5) - 0.9).abs() < 1e-6);
        let below = transfer_at_values(&COLOR, &OPACITY, Window::new(-2000.0, -1000.0).unwrap()).unwrap();
        assert_eq!(below.opacity_at(1.0), 0.0);
    }

    #[test]
    fn disorder_is_refused() {
        let window = Window::new(0.0, 1.0).unwrap();
        assert!(transfer_at_values(&[], &OPACITY, window).is_err());
        let swapped = [(1.0, 0.0), (0.0, 1.0)];
        assert!(matches!(
            transfer_at_values(&COLOR, &swapped, window),
            Err(TransferError::Order { part: "opacity", index: 1, .. })
        ));
        assert!(transfer_at_values(&COLOR, &[(f64::NAN, 0.0)], window).is_err());
    }
}
