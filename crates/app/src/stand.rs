//! How large a volume is at a light-field display, and where.

use crate::camera::{AimArgs, turn_deg};
use crate::failure::Failure;
use crate::spec;
use clap::Args;
use glam::{DAffine3, DVec3};
use std::ops::Range;

/// Flags of where a volume stands at a display.
#[derive(Debug, Clone, Args)]
pub(crate) struct StandArgs {
    /// Length of the volume's longest side at the display, metres [default: as much as the screen shows in full].
    #[arg(long, value_name = "M", value_parser = spec::within(1e-4..=1000.0), allow_negative_numbers = true)]
    volume_size: Option<f64>,

    /// How far before the screen the volume's centre is, metres; negative behind it.
    #[arg(long, value_name = "M", default_value = "0", value_parser = spec::within(-1000.0..=1000.0), allow_negative_numbers = true)]
    before_screen: f64,

    /// Write N pictures, numbered from 0000, turning by 360/N degrees from one to the next.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    turntable: Option<u32>,
}

/// Where a volume stands, in each picture of a turntable.
#[derive(Debug, Clone)]
pub(crate) struct Stand {
    /// Length of the volume's longest side, metres.
    pub(crate) volume_size_m: f64,
    /// How far before the screen the volume reaches in any picture, metres: from behind, which is negative.
    pub(crate) reach_m: Range<f64>,
    before_screen_m: f64,
    /// The volume turned about its centre, its longest side of length 1.
    turned: Vec<DAffine3>,
    is_turning: bool,
}

impl StandArgs {
    /// Whether pictures of a turntable are asked for, be it of one.
    pub(crate) fn is_turning(&self) -> bool {
        self.turntable.is_some()
    }

    /// Pictures that are asked for.
    pub(crate) fn pictures(&self) -> u32 {
        self.turntable.unwrap_or(1)
    }

    /// Where a volume stands before somebody who is so far from the screen, metres. Its visible corners are in a world in which its longest side
    /// is 1 m; `largest_scale` tells by how much points may be scaled about a place before the screen to be seen in full.
    pub(crate) fn resolve(
        &self,
        aim: &AimArgs,
        corners: [DVec3; 8],
        (seen_by, from_screen_m): (&str, f64),
        largest_scale: impl FnOnce(&[DVec3], f64) -> f64,
    ) -> Result<Stand, Failure> {
        let before_screen_m = self.before_screen;
        if before_screen_m >= from_screen_m {
            return Err(Failure::input(format!(
                "--before-screen must be less than the distance of the {seen_by}, {from_screen_m:.4} m"
            )));
        }
        let frames = self.pictures();
        let turned: Vec<DAffine3> =
            (0..frames).map(|frame| aim.orbit(turn_deg(frame, frames), 0.0).view_from_world()).collect();
        let points: Vec<DVec3> =
            turned.iter().flat_map(|turn| corners.map(|corner| turn.transform_point3(corner))).collect();
        let volume_size_m = self.volume_size.unwrap_or_else(|| largest_scale(&points, before_screen_m));
        if !(volume_size_m.is_finite() && volume_size_m > 0.0) {
            return Err(Failure::input("nothing of the volume is visible: --volume-size is needed"));
        }
        let before_m = points.iter().map(|point| before_screen_m + volume_size_m * point.z);
        let (least_m, most_m) =
            before_m.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), z| (lo.min(z), hi.max(z)));
        let is_turning = self.is_turning();
        Ok(Stand { volume_size_m, reach_m: least_m..most_m, before_screen_m, turned, is_turning })
    }
}

impl Stand {
    /// From where to where the volume reaches, in words, with distances from the screen as `written`.
    pub(crate) fn reach(&self, written: impl Fn(f64) -> String) -> String {
        let (from_m, to_m) = (self.reach_m.start, self.reach_m.end);
        let [from, to] = [from_m, to_m].map(|before_m| written(before_m.abs()));
        match (from_m < 0.0, to_m > 0.0) {
            (true, true) => format!("from {from} behind to {to} before the screen"),
            (true, false) => format!("from {from} to {to} behind the screen"),
            (false, _) => format!("from {from} to {to} before the screen"),
        }
    }

    /// Where the volume's world is at the display, picture by picture.
    pub(crate) fn displays_from_world(&self) -> impl Iterator<Item = DAffine3> {
        let stand = DAffine3::from_translation(DVec3::Z * self.before_screen_m)
            * DAffine3::from_scale(DVec3::splat(self.volume_size_m));
        self.turned.iter().map(move |turn| stand * *turn)
    }

    /// Pictures that are made.
    pub(crate) fn pictures(&self) -> u32 {
        self.turned.len() as u32
    }

    /// Whether they are those of a turntable, be it of one.
    pub(crate) fn is_turning(&self) -> bool {
        self.is_turning
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reach_names_the_sides_of_the_screen_that_it_is_on() {
        let reach = |reach_m: Range<f64>| {
            let stand = Stand {
                volume_size_m: 1.0,
                reach_m,
                before_screen_m: 0.0,
                turned: Vec::new(),
                is_turning: false,
            };
            stand.reach(|metres| format!("{metres} m"))
        };
        assert_eq!(reach(-0.25..0.5), "from 0.25 m behind to 0.5 m before the screen");
        assert_eq!(reach(-900.5..-899.5), "from 900.5 m to 899.5 m behind the screen");
        assert_eq!(reach(-1.0..0.0), "from 1 m to 0 m behind the screen");
        assert_eq!(reach(0.5..1.0), "from 0.5 m to 1 m before the screen");
        assert_eq!(reach(0.0..1.0), "from 0 m to 1 m before the screen");
    }
}
