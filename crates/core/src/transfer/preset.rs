//! Named transfer functions.

use super::{Colormap, TransferError, TransferFunction, transfer_at_values};
use crate::volume::{Statistics, Window};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A transfer function by name.
///
/// The CT presets are made of points in Hounsfield units and fit any window; the others are made of normalised
/// values. All opacities are of one voxel length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Preset {
    /// Bone, opaque from about 200 HU.
    CtBone,
    /// Fat, muscle, enhanced vessels and bone, each more opaque than the one before.
    CtSoftTissue,
    /// Lung tissue and its vessels, with a hint of bone.
    CtLung,
    /// Contrast-filled vessels (150 HU and more) and bone.
    CtVessels,
    /// Grey and white matter of a T1-weighted head, in units of the robust window.
    MriBrainT1,
    /// A soft grey ramp.
    Generic,
    /// A colour map with an opacity that rises evenly from 0 to 1.
    Colormap(Colormap),
}

/// A name that is no preset's.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no preset is called {name:?}; there are {names}", names = names())]
pub struct UnknownPreset {
    /// The name given.
    pub name: String,
}

/// Colour points and opacity points over value, in Hounsfield units or normalised.
struct Points {
    color: &'static [(f64, [f64; 3])],
    opacity: &'static [(f64, f64)],
}

const BONE: Points = Points {
    color: &[
        (-50.0, [0.55, 0.18, 0.14]),
        (120.0, [0.73, 0.32, 0.24]),
        (300.0, [0.87, 0.66, 0.45]),
        (650.0, [0.93, 0.85, 0.66]),
        (1500.0, [1.0, 0.98, 0.93]),
    ],
    opacity: &[(120.0, 0.0), (200.0, 0.04), (350.0, 0.35), (650.0, 0.7), (3000.0, 0.75)],
};

const SOFT_TISSUE: Points = Points {
    color: &[
        (-200.0, [0.85, 0.65, 0.45]),
        (-80.0, [0.92, 0.76, 0.52]),
        (0.0, [0.70, 0.34, 0.24]),
        (70.0, [0.74, 0.26, 0.20]),
        (180.0, [0.88, 0.46, 0.34]),
        (350.0, [0.95, 0.84, 0.68]),
        (1500.0, [1.0, 0.98, 0.94]),
    ],
    opacity: &[
        (-160.0, 0.0),
        (-90.0, 0.015),
        (-20.0, 0.02),
        (50.0, 0.16),
        (150.0, 0.22),
        (300.0, 0.45),
        (1500.0, 0.75),
    ],
};

const LUNG: Points = Points {
    color: &[
        (-950.0, [0.32, 0.12, 0.20]),
        (-800.0, [0.62, 0.28, 0.30]),
        (-600.0, [0.86, 0.52, 0.42]),
        (-400.0, [0.97, 0.78, 0.60]),
        (200.0, [0.90, 0.86, 0.78]),
        (1500.0, [1.0, 0.98, 0.94]),
    ],
    opacity: &[
        (-930.0, 0.0),
        (-850.0, 0.006),
        (-700.0, 0.025),
        (-520.0, 0.12),
        (-380.0, 0.08),
        (-280.0, 0.0),
        (350.0, 0.0),
        (700.0, 0.05),
        (1500.0, 0.08),
    ],
};

const VESSELS: Points = Points {
    color: &[
        (130.0, [0.55, 0.16, 0.12]),
        (180.0, [0.82, 0.24, 0.16]),
        (280.0, [0.93, 0.46, 0.30]),
        (420.0, [0.97, 0.82, 0.62]),
        (900.0, [1.0, 0.96, 0.90]),
    ],
    opacity: &[(130.0, 0.0), (180.0, 0.12), (260.0, 0.55), (450.0, 0.72), (3000.0, 0.8)],
};

const BRAIN_T1: Points = Points {
    color: &[
        (0.0, [0.20, 0.07, 0.07]),
        (0.3, [0.45, 0.22, 0.20]),
        (0.55, [0.76, 0.56, 0.50]),
        (0.75, [0.88, 0.78, 0.70]),
        (1.0, [1.0, 0.97, 0.92]),
    ],
    opacity: &[(0.12, 0.0), (0.3, 0.008), (0.45, 0.03), (0.62, 0.12), (0.85, 0.3), (1.0, 0.4)],
};

const GENERIC: Points =
    Points { color: &[(0.0, [0.15; 3]), (1.0, [1.0; 3])], opacity: &[(0.05, 0.0), (0.4, 0.03), (1.0, 0.25)] };

impl Preset {
    /// Every preset: those with names of their own, then one for each colour map.
    pub fn all() -> impl Iterator<Item = Self> {
        [Self::CtBone, Self::CtSoftTissue, Self::CtLung, Self::CtVessels, Self::MriBrainT1, Self::Generic]
            .into_iter()
            .chain(Colormap::ALL.iter().map(|&map| Self::Colormap(map)))
    }

    /// Name as written on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::CtBone => "ct-bone",
            Self::CtSoftTissue => "ct-soft-tissue",
            Self::CtLung => "ct-lung",
            Self::CtVessels => "ct-vessels",
            Self::MriBrainT1 => "mri-brain-t1",
            Self::Generic => "generic",
            Self::Colormap(map) => map.name(),
        }
    }

    /// The window that shows the preset best, in the volume's unit: fixed Hounsfield units for CT, the robust window
    /// for MRI; `None` where any window does.
    pub fn recommended_window(self, statistics: &Statistics) -> Option<Window> {
        let (lo, hi) = match self {
            Self::CtBone | Self::CtVessels => (-100.0, 1500.0),
            Self::CtSoftTissue => (-200.0, 1500.0),
            Self::CtLung => (-1000.0, 1500.0),
            Self::MriBrainT1 => return Some(statistics.robust_window()),
            Self::Generic | Self::Colormap(_) => return None,
        };
        Window::new(lo, hi).ok()
    }

    /// The transfer function for values that are normalised by `window`: CT presets keep their Hounsfield units
    /// whatever the window is.
    ///
    /// # Errors
    /// None for the presets as they are; [`TransferError`] stands for points that make no function.
    pub fn transfer(self, window: Window) -> Result<TransferFunction, TransferError> {
        let unit_window = Window::new(0.0, 1.0).unwrap_or(window);
        let (points, window) = match self {
            Self::CtBone => (BONE, window),
            Self::CtSoftTissue => (SOFT_TISSUE, window),
            Self::CtLung => (LUNG, window),
            Self::CtVessels => (VESSELS, window),
            Self::MriBrainT1 => (BRAIN_T1, unit_window),
            Self::Generic => (GENERIC, unit_window),
            Self::Colormap(map) => {
                let ramp = TransferFunction::ramp(0.0, 1.0)?;
                return TransferFunction::new(map.color_points(65), ramp.opacity_points().to_vec());
            }
        };
        transfer_at_values(points.color, points.opacity, window)
    }
}

fn names() -> String {
    Preset::all().map(Preset::name).collect::<Vec<_>>().join(", ")
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Preset {
    type Err = UnknownPreset;

    fn from_str(name: &str) -> Result<Self, UnknownPreset> {
        Self::all()
            .find(|preset| preset.name() == name)
            .ok_or_else(|| UnknownPreset { name: name.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Volume, Voxels};

    fn statistics() -> Statistics {
        let grid = Grid::centred([4, 1, 1], [1.0; 3]).unwrap();
        Volume::new(grid, Voxels::I16(vec![-1000, 0, 100, 1000])).unwrap().statistics()
    }

    fn opacity_at_hu(preset: Preset, window: Window, hu: f64) -> f32 {
        preset.transfer(window).unwrap().opacity_at(window.normalise(hu) as f32)
    }

    #[test]
    fn names_come_back_and_every_preset_has_a_function() {
        let windows = [(-1024.0, 3071.0), (0.0, 1.0), (200.0, 210.0), (-3000.0, -2000.0), (-1e300, 0.5e300)];
        for preset in Preset::all() {
            assert_eq!(preset.name().parse::<Preset>().unwrap(), preset);
            for (lo, hi) in windows {
                preset.transfer(Window::new(lo, hi).unwrap()).unwrap();
            }
            if let Some(window) = preset.recommended_window(&statistics()) {
                let transfer = preset.transfer(window).unwrap();
                assert_eq!(transfer.opacity_at(0.0), 0.0, "{preset}");
                assert!((1..=100).any(|i| transfer.opacity_at(i as f32 / 100.0) > 0.05), "{preset}");
            }
        }
        assert!("ct-bones".parse::<Preset>().unwrap_err().to_string().contains("ct-bone,"));
    }

    #[test]
    fn hounsfield_units_mean_the_same_in_every_window() {
        for (lo, hi) in [(-1024.0, 3071.0), (-200.0, 1500.0), (-2000.0, 900.0)] {
            let window = Window::new(lo, hi).unwrap();
            assert_eq!(opacity_at_hu(Preset::CtBone, window, -1000.0), 0.0, "air");
            assert_eq!(opacity_at_hu(Preset::CtBone, window, 60.0), 0.0, "muscle");
            assert!((opacity_at_hu(Preset::CtBone, window, 500.0) - 0.525).abs() < 1e-3, "bone");
            assert!(opacity_at_hu(Preset::CtSoftTissue, window, 60.0) > 0.1, "muscle");
            assert_eq!(opacity_at_hu(Preset::CtVessels, window, 60.0), 0.0, "unenhanced blood");
            assert!(opacity_at_hu(Preset::CtVessels, window, 300.0) > 0.5, "enhanced blood");
        }
        let lung = Window::new(-1000.0, 1500.0).unwrap();
        assert_eq!(opacity_at_hu(Preset::CtLung, lung, -1000.0), 0.0, "air");
        assert!(opacity_at_hu(Preset::CtLung, lung, -500.0) > 0.1, "lung vessels");
        assert_eq!(opacity_at_hu(Preset::CtLung, lung, 50.0), 0.0, "muscle");
    }
}
