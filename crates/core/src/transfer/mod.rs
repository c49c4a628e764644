//! Transfer functions: from a normalised value (and gradient magnitude) to colour and opacity.
//!
//! Opacity is per unit length: α is the opacity of one voxel length, and a step of Δ voxel lengths
//! contributes `1 − (1 − α)^Δ`. Colours are display-referred (as VTK and ParaView composite them).

mod automatic;
mod benchmark;
pub mod color_space;
mod colormap;
mod file;
mod json;
mod lut;
mod preset;

pub use automatic::{AUTOMATIC_BINS, automatic};
pub use benchmark::BenchmarkRamp;
pub use colormap::{Colormap, UnknownColormap};
pub use file::{TransferFile, transfer_at_values};
pub use json::{JSON_VERSION, TransferJsonError};
pub use lut::{LUT_1D_ENTRIES, Lut, LutEntry, OPAQUE_LOG2};
pub use preset::{Preset, UnknownPreset};

use thiserror::Error;

/// Colour and opacity as a function of the normalised value, or of value and gradient magnitude.
///
/// All three parts are piecewise linear and constant beyond their ends. The gradient magnitude is that of the
/// normalised value per voxel length; its opacity multiplies the value's (DM Eq. 16 generalised).
#[derive(Debug, Clone, PartialEq)]
pub struct TransferFunction {
    color: Vec<ColorPoint>,
    opacity: Vec<OpacityPoint>,
    gradient_opacity: Vec<OpacityPoint>,
}

/// A colour at a normalised value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorPoint {
    /// Normalised value.
    pub at: f32,
    /// Display-referred colour, each channel in [0, 1].
    pub rgb: [f32; 3],
}

/// An opacity at a normalised value or gradient magnitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpacityPoint {
    /// Normalised value, or gradient magnitude per voxel length.
    pub at: f32,
    /// Opacity of one voxel length, in [0, 1].
    pub alpha: f32,
}

/// Why points do not make a transfer function.
#[derive(Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TransferError {
    /// A part that needs a point has none.
    #[error("a transfer function needs at least one {0} point")]
    NoPoints(&'static str),
    /// Positions are not finite or decrease.
    #[error("{part} point {index} is at {at}: positions must be finite and not decrease")]
    Order {
        /// `color`, `opacity` or `gradient opacity`.
        part: &'static str,
        /// Which point, from 0.
        index: usize,
        /// Its position.
        at: f32,
    },
    /// A colour channel or an opacity outside [0, 1].
    #[error("{part} point {index} holds {value}: must be within 0 and 1")]
    Channel {
        /// `color`, `opacity` or `gradient opacity`.
        part: &'static str,
        /// Which point, from 0.
        index: usize,
        /// The offending number.
        value: f32,
    },
}

impl TransferFunction {
    /// A one-dimensional transfer function.
    ///
    /// # Errors
    /// Missing points, positions out of order, channels outside [0, 1].
    pub fn new(color: Vec<ColorPoint>, opacity: Vec<OpacityPoint>) -> Result<Self, TransferError> {
        if color.is_empty() {
            return Err(TransferError::NoPoints("color"));
        }
        if opacity.is_empty() {
            return Err(TransferError::NoPoints("opacity"));
        }
        check_order("color", color.iter().map(|p| p.at))?;
        check_channels("color", color.iter().map(|p| &p.rgb[..]))?;
        check_opacity("opacity", &opacity)?;
        Ok(Self { color, opacity, gradient_opacity: Vec::new() })
    }

    /// The same with an opacity factor by gradient magnitude, which makes it two-dimensional. No points: one-dimensional.
    ///
    /// # Errors
    /// Positions out of order, opacities outside [0, 1].
    pub fn with_gradient_opacity(mut self, points: Vec<OpacityPoint>) -> Result<Self, TransferError> {
        check_opacity("gradient opacity", &points)?;
        self.gradient_opacity = points;
        Ok(self)
    }

    /// The grey ramp of DM Eq. 16: opacity and grey level rise from 0 at `v0` to 1 at `v1`.
    ///
    /// # Errors
    /// Bounds that are not finite or not in order.
    pub fn ramp(v0: f32, v1: f32) -> Result<Self, TransferError> {
        let grey = |at, level| ColorPoint { at, rgb: [level; 3] };
        Self::new(vec![grey(v0, 0.0), grey(v1, 1.0)], ramp_points(v0, v1))
    }

    /// The two-dimensional ramp of DM Eq. 16: the opacity also rises from 0 at gradient magnitude `g0` to 1 at `g1`.
    ///
    /// # Errors
    /// Bounds that are not finite or not in order.
    pub fn ramp_2d(v0: f32, v1: f32, g0: f32, g1: f32) -> Result<Self, TransferError> {
        Self::ramp(v0, v1)?.with_gradient_opacity(ramp_points(g0, g1))
    }

    /// Whether the opacity depends on the gradient magnitude.
    pub fn is_2d(&self) -> bool {
        !self.gradient_opacity.is_empty()
    }

    /// Colour points in order.
    pub fn color_points(&self) -> &[ColorPoint] {
        &self.color
    }

    /// Opacity points in order.
    pub fn opacity_points(&self) -> &[OpacityPoint] {
        &self.opacity
    }

    /// Gradient-opacity points in order; empty for a one-dimensional function.
    pub fn gradient_opacity_points(&self) -> &[OpacityPoint] {
        &self.gradient_opacity
    }

    /// Colour at a normalised value.
    pub fn color_at(&self, value: f32) -> [f32; 3] {
        let (below, above, t) = bracket(&self.color, |p| p.at, value);
        [0, 1, 2].map(|c| below.rgb[c] + (above.rgb[c] - below.rgb[c]) * t)
    }

    /// Opacity of one voxel length at a normalised value, the gradient's part left out.
    pub fn opacity_at(&self, value: f32) -> f32 {
        alpha_at(&self.opacity, value)
    }

    /// Opacity factor at a gradient magnitude; 1 for a one-dimensional function.
    pub fn gradient_opacity_at(&self, gradient_magnitude: f32) -> f32 {
        if self.is_2d() { alpha_at(&self.gradient_opacity, gradient_magnitude) } else { 1.0 }
    }
}

fn ramp_points(from: f32, to: f32) -> Vec<OpacityPoint> {
    vec![OpacityPoint { at: from, alpha: 0.0 }, OpacityPoint { at: to, alpha: 1.0 }]
}

fn alpha_at(points: &[OpacityPoint], at: f32) -> f32 {
    let (below, above, t) = bracket(points, |p| p.at, at);
    below.alpha + (above.alpha - below.alpha) * t
}

/// The points on both sides of a position and where between them it lies; at a jump, the point after it counts.
fn bracket<P>(points: &[P], position: impl Fn(&P) -> f32, at: f32) -> (&P, &P, f32) {
    let after = points.partition_point(|p| position(p) <= at);
    let (below, above) = (&points[after.saturating_sub(1)], &points[after.min(points.len() - 1)]);
    let width = position(above) - position(below);
    let t = if width > 0.0 { (at - position(below)) / width } else { 0.0 };
    (below, above, t)
}

fn check_order(part: &'static str, positions: impl Iterator<Item = f32>) -> Result<(), TransferError> {
    let mut previous = f32::NEG_INFINITY;
    for (index, at) in positions.enumerate() {
        if !at.is_finite() || at < previous {
            return Err(TransferError::Order { part, index, at });
        }
        previous = at;
    }
    Ok(())
}

fn check_channels<'a>(
    part: &'static str,
    points: impl Iterator<Item = &'a [f32]>,
) -> Result<(), TransferError> {
    for (index, channels) in points.enumerate() {
        if let Some(&value) = channels.iter().find(|c| !(0.0..=1.0).contains(*c)) {
            return Err(TransferError::Channel { part, index, value });
        }
    }
    Ok(())
}

fn check_opacity(part: &'static str, points: &[OpacityPoint]) -> Result<(), TransferError> {
    check_order(part, points.iter().map(|p| p.at))?;
    check_channels(part, points.iter().map(|p| std::slice::from_ref(&p.alpha)))
}
