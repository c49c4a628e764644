//! The transfer function as it is edited: points over a window of values.

use serde::{Deserialize, Serialize};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferError, TransferFunction};
use wheatstone_core::volume::{Window, WindowError};

/// Most points of each kind.
const MOST_POINTS: usize = 256;

/// Colour and opacity over normalised values. A point's values are clamped where it would pass its neighbours.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Transfer {
    /// Values that become 0 and 1, in the file's unit.
    pub(crate) window: [f64; 2],
    /// Value, red, green, blue.
    pub(crate) color: Vec<[f32; 4]>,
    /// Value, opacity of one voxel length.
    pub(crate) opacity: Vec<[f32; 2]>,
    /// Gradient magnitude, factor of the opacity; empty for a one-dimensional function.
    #[serde(default)]
    pub(crate) gradient_opacity: Vec<[f32; 2]>,
}

impl Default for Transfer {
    /// A grey ramp, until there is a volume.
    fn default() -> Self {
        Self {
            window: [0.0, 1.0],
            color: vec![[0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0]],
            opacity: vec![[0.0, 0.0], [1.0, 0.5]],
            gradient_opacity: Vec::new(),
        }
    }
}

impl Transfer {
    /// That of a function over a window.
    pub(crate) fn of(function: &TransferFunction, window: Window) -> Self {
        let opacity = |points: &[OpacityPoint]| points.iter().map(|p| [p.at, p.alpha]).collect();
        Self {
            window: [window.lo(), window.hi()],
            color: function.color_points().iter().map(|p| [p.at, p.rgb[0], p.rgb[1], p.rgb[2]]).collect(),
            opacity: opacity(function.opacity_points()),
            gradient_opacity: opacity(function.gradient_opacity_points()),
        }
    }

    /// What the casters take.
    pub(crate) fn function(&self) -> Result<TransferFunction, TransferError> {
        let color = self.color.iter().map(|&[at, r, g, b]| ColorPoint { at, rgb: [r, g, b] }).collect();
        let opacity = |points: &[[f32; 2]]| {
            points.iter().map(|&[at, alpha]| OpacityPoint { at, alpha }).collect::<Vec<_>>()
        };
        TransferFunction::new(color, opacity(&self.opacity))?
            .with_gradient_opacity(opacity(&self.gradient_opacity))
    }

    /// The window.
    pub(crate) fn window(&self) -> Result<Window, WindowError> {
        Window::new(self.window[0], self.window[1])
    }

    /// Shifts the window by parts of its width and makes it so many times as wide about its middle.
    pub(super) fn window_level(&mut self, shift: f64, stretch: f64) {
        let changed = self.window().and_then(|window| window.shifted_and_stretched(shift, stretch));
        // Bounds that make no window are refused by the check.
        self.window = changed.map_or_else(|error| [error.lo, error.hi], |window| [window.lo(), window.hi()]);
    }

    /// Moves an opacity point as far as its neighbours allow.
    pub(super) fn move_opacity(&mut self, index: usize, [at, alpha]: [f32; 2]) -> Result<(), String> {
        let at = between_neighbours(&self.opacity, index, at);
        *point(&mut self.opacity, index)? = [at, alpha.clamp(0.0, 1.0)];
        Ok(())
    }

    /// Moves a colour point as far as its neighbours allow, and colours it.
    pub(super) fn set_color(&mut self, index: usize, [at, r, g, b]: [f32; 4]) -> Result<(), String> {
        let at = between_neighbours(&self.color, index, at);
        *point(&mut self.color, index)? = [at, r, g, b];
        Ok(())
    }

    pub(super) fn add_opacity(&mut self, point: [f32; 2]) {
        insert(&mut self.opacity, point);
    }

    /// Adds a colour point where the function is, so that nothing changes yet.
    pub(super) fn add_color(&mut self, at: f32) {
        if let Ok(function) = self.function() {
            let [r, g, b] = function.color_at(at);
            insert(&mut self.color, [at, r, g, b]);
        }
    }

    pub(super) fn remove_opacity(&mut self, index: usize) -> Result<(), String> {
        remove(&mut self.opacity, index)
    }

    pub(super) fn remove_color(&mut self, index: usize) -> Result<(), String> {
        remove(&mut self.color, index)
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let most = self.color.len().max(self.opacity.len()).max(self.gradient_opacity.len());
        if most > MOST_POINTS {
            return Err(format!("{most} points: at most {MOST_POINTS} of each kind"));
        }
        self.window().map_err(|error| error.to_string())?;
        self.function().map(drop).map_err(|error| error.to_string())
    }
}

/// A position of a point that keeps the order.
fn between_neighbours<const N: usize>(points: &[[f32; N]], index: usize, at: f32) -> f32 {
    let lowest = index.checked_sub(1).and_then(|before| points.get(before)).map_or(0.0, |point| point[0]);
    let highest = points.get(index.saturating_add(1)).map_or(1.0, |point| point[0]);
    at.min(highest).max(lowest)
}

fn insert<const N: usize>(points: &mut Vec<[f32; N]>, point: [f32; N]) {
    let index = points.partition_point(|other| other[0] <= point[0]);
    points.insert(index, point);
}

/// A point by its number.
fn point<const N: usize>(points: &mut [[f32; N]], index: usize) -> Result<&mut [f32; N], String> {
    let last = points.len().saturating_sub(1);
    points.get_mut(index).ok_or_else(|| format!("point {index}: must be from 0 to {last}"))
}

/// Takes a point away, but not the last one.
fn remove<const N: usize>(points: &mut Vec<[f32; N]>, index: usize) -> Result<(), String> {
    point(points, index)?;
    if points.len() == 1 {
        return Err("the last point cannot be removed: a function has at least one".to_owned());
    }
    points.remove(index);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_function_comes_back() {
        let function = TransferFunction::ramp_2d(0.1, 0.9, 0.0, 0.3).unwrap();
        let window = Window::new(-100.0, 300.0).unwrap();
        let transfer = Transfer::of(&function, window);
        assert_eq!(transfer.function().unwrap(), function);
        assert_eq!(transfer.window().unwrap(), window);
    }

    #[test]
    fn a_colour_point_that_is_added_changes_nothing() {
        let mut transfer = Transfer::default();
        let before = transfer.function().unwrap();
        transfer.add_color(0.3);
        assert_eq!(transfer.color.len(), 3);
        assert_eq!(transfer.function().unwrap().color_at(0.6), before.color_at(0.6));
    }

    #[test]
    fn the_window_shifts_and_widens_about_its_middle() {
        let mut transfer = Transfer { window: [100.0, 300.0], ..Transfer::default() };
        transfer.window_level(0.5, 2.0);
        assert_eq!(transfer.window, [100.0, 500.0]);
        transfer.window_level(0.0, 0.0);
        assert!(transfer.check().is_ok(), "{:?}", transfer.window);
    }

    proptest! {
        #[test]
        fn edits_keep_a_transfer_function(
            edits in prop::collection::vec((0..6_u8, 0..8_usize, -0.5_f32..1.5, -0.5_f32..1.5), 0..40),
        ) {
            let mut transfer = Transfer::default();
            for (kind, index, at, alpha) in edits {
                let before = transfer.clone();
                let edited = match kind {
                    0 => transfer.move_opacity(index, [at, alpha]),
                    1 => transfer.set_color(index, [at, 0.5, 0.25, 1.0]),
                    2 => transfer.remove_opacity(index),
                    3 => transfer.remove_color(index),
                    4 => {
                        transfer.add_opacity([at.clamp(0.0, 1.0), alpha.clamp(0.0, 1.0)]);
                        Ok(())
                    }
                    _ => {
                        transfer.add_color(at.clamp(0.0, 1.0));
                        Ok(())
                    }
                };
                prop_assert_eq!(transfer.check(), Ok(()));
                prop_assert!(edited.is_ok() || transfer == before);
            }
        }
    }
}
