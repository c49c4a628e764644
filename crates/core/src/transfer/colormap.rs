//! Named colour maps.

use super::ColorPoint;
use super::color_space::mix_diverging;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A colour map over [0, 1], display-referred.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Colormap {
    /// Perceptually even, dark blue to yellow (van der Walt and Smith 2015).
    Viridis,
    /// Perceptually even, black through red to pale yellow.
    Inferno,
    /// Perceptually even, black through purple to pale pink.
    Magma,
    /// Perceptually even, blue through magenta to yellow.
    Plasma,
    /// A smooth rainbow (Mikhailov 2019).
    Turbo,
    /// Even for colour-deficient eyes, blue to yellow (Nuñez et al. 2018).
    Cividis,
    /// Black to white.
    Gray,
    /// Blue through white to red (Moreland 2009).
    Coolwarm,
    /// Black through red and yellow to white, as matplotlib defines it.
    Hot,
}

/// A name that is no colour map's.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no colour map is called {0:?}; there are {names}", names = Colormap::names())]
pub struct UnknownColormap(pub String);

impl Colormap {
    /// Every colour map.
    pub const ALL: &[Self] = &[
        Self::Viridis,
        Self::Inferno,
        Self::Magma,
        Self::Plasma,
        Self::Turbo,
        Self::Cividis,
        Self::Gray,
        Self::Coolwarm,
        Self::Hot,
    ];

    /// Name as written in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Viridis => "viridis",
            Self::Inferno => "inferno",
            Self::Magma => "magma",
            Self::Plasma => "plasma",
            Self::Turbo => "turbo",
            Self::Cividis => "cividis",
            Self::Gray => "gray",
            Self::Coolwarm => "coolwarm",
            Self::Hot => "hot",
        }
    }

    /// Colour at a position, clamped to [0, 1]. Display-referred, each channel in [0, 1].
    pub fn color_at(self, position: f32) -> [f32; 3] {
        let t = f64::from(if position.is_nan() { 0.0 } else { position.clamp(0.0, 1.0) });
        let table = |gradient: colorous::Gradient| {
            let color = gradient.eval_continuous(t);
            [color.r, color.g, color.b].map(|c| f32::from(c) / 255.0)
        };
        match self {
            Self::Viridis => table(colorous::VIRIDIS),
            Self::Inferno => table(colorous::INFERNO),
            Self::Magma => table(colorous::MAGMA),
            Self::Plasma => table(colorous::PLASMA),
            Self::Turbo => table(colorous::TURBO),
            Self::Cividis => table(colorous::CIVIDIS),
            Self::Gray => [t as f32; 3],
            Self::Coolwarm => mix_diverging(COOL, WARM, t).map(|c| c as f32),
            Self::Hot => hot(t).map(|c| c as f32),
        }
    }

    /// The map sampled at `count` even positions from 0 to 1 (at least 2).
    pub fn color_points(self, count: usize) -> Vec<ColorPoint> {
        let last = count.max(2) - 1;
        (0..=last)
            .map(|i| i as f32 / last as f32)
            .map(|at| ColorPoint { at, rgb: self.color_at(at) })
            .collect()
    }

    fn names() -> String {
        Self::ALL.iter().map(|map| map.name()).collect::<Vec<_>>().join(", ")
    }
}

/// Ends of Moreland's "cool to warm".
const COOL: [f64; 3] = [59.0 / 255.0, 76.0 / 255.0, 192.0 / 255.0];
const WARM: [f64; 3] = [180.0 / 255.0, 4.0 / 255.0, 38.0 / 255.0];

/// Red rises over the first 36.5 %, green over the next 38.1 %, blue over the rest (matplotlib's `hot`).
fn hot(t: f64) -> [f64; 3] {
    const RED_FULL: f64 = 0.365_079;
    const GREEN_FULL: f64 = 0.746_032;
    let rise = |from: f64, to: f64| ((t - from) / (to - from)).clamp(0.0, 1.0);
    [0.0416 + (1.0 - 0.0416) * rise(0.0, RED_FULL), rise(RED_FULL, GREEN_FULL), rise(GREEN_FULL, 1.0)]
}

impl fmt::Display for Colormap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Colormap {
    type Err = UnknownColormap;

    fn from_str(name: &str) -> Result<Self, UnknownColormap> {
        Self::ALL
            .iter()
            .copied()
            .find(|map| map.name() == name)
            .ok_or_else(|| UnknownColormap(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_rgb8(map: Colormap, at: f32, expected: [i32; 3], tolerance: i32) {
        let found = map.color_at(at).map(|c| (c * 255.0).round() as i32);
        let close = found.iter().zip(expected).all(|(f, e)| (f - e).abs() <= tolerance);
        assert!(close, "{map} at {at}: {found:?} is not {expected:?}");
    }

    #[test]
    fn known_colours() {
        assert_rgb8(Colormap::Viridis, 0.0, [68, 1, 84], 1);
        assert_rgb8(Colormap::Viridis, 1.0, [253, 231, 37], 1);
        assert_rgb8(Colormap::Inferno, 0.5, [188, 55, 84], 2);
        assert_rgb8(Colormap::Gray, 0.5, [128, 128, 128], 1);
        assert_rgb8(Colormap::Hot, 0.0, [11, 0, 0], 1);
        assert_rgb8(Colormap::Hot, 0.5, [255, 90, 0], 1);
        assert_rgb8(Colormap::Hot, 1.0, [255, 255, 255], 0);
    }

    /// Entries 0, 8, 16, 24 and 32 of the 33-point table that Moreland published.
    #[test]
    fn coolwarm_is_morelands_table() {
        assert_rgb8(Colormap::Coolwarm, 0.0, [59, 76, 192], 1);
        assert_rgb8(Colormap::Coolwarm, 0.25, [141, 176, 254], 1);
        assert_rgb8(Colormap::Coolwarm, 0.5, [221, 221, 221], 1);
        assert_rgb8(Colormap::Coolwarm, 0.75, [244, 152, 122], 2);
        assert_rgb8(Colormap::Coolwarm, 1.0, [180, 4, 38], 1);
    }

    #[test]
    fn names_come_back_and_points_are_in_order() {
        for &map in Colormap::ALL {
            assert_eq!(map.name().parse::<Colormap>().unwrap(), map);
            let points = map.color_points(33);
            assert_eq!((points.len(), points[0].at, points[32].at), (33, 0.0, 1.0));
            assert!(points.iter().all(|p| p.rgb.iter().all(|c| (0.0..=1.0).contains(c))));
        }
        assert_eq!(Colormap::Hot.color_points(0).len(), 2);
        assert!("jet".parse::<Colormap>().unwrap_err().to_string().contains("viridis"));
        assert_eq!(Colormap::Hot.color_at(f32::NAN), Colormap::Hot.color_at(0.0));
    }
}
