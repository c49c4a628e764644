//! Where the eyes are and what they look through.

use crate::failure::Failure;
use crate::picture::Picture;
use crate::spec;
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};
use wheatstone_core::image::{Image, RgbImage};
use wheatstone_core::scene::Placement;
use wheatstone_core::view::{
    AnatomicalDirection, Frustum, Orbit, OrthographicBox, Projection, Rig, View, world_from_patient,
};
use wheatstone_core::volume::Volume;

/// Distance of the default camera, metres: the DM test camera's √3.
const DEFAULT_DISTANCE: &str = "1.7320508";

/// Camera flags. The volume's longest side is 1 m and its centre is the world's origin.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Camera")]
pub(crate) struct CameraArgs {
    /// Width and height of each eye's picture, pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = spec::picture_size)]
    pub(crate) size: [u32; 2],

    #[command(flatten)]
    pub(crate) aim: AimArgs,

    /// Distance of the eye from the volume's centre, metres.
    #[arg(long, value_name = "M", default_value = DEFAULT_DISTANCE, value_parser = spec::within(0.0..=1000.0), allow_negative_numbers = true)]
    pub(crate) distance: f64,

    /// Field of view of the shorter side of a picture, radians.
    #[arg(long, value_name = "RAD", default_value = "1", value_parser = spec::fov, allow_negative_numbers = true)]
    pub(crate) fov: f64,

    /// Parallel rays, with a picture that is so many metres high.
    #[arg(long, value_name = "HEIGHT_M", value_parser = spec::within(0.001..=1000.0), allow_negative_numbers = true, conflicts_with = "fov")]
    pub(crate) orthographic: Option<f64>,

    /// One picture for one eye, or for two: the left eye's on the left, on top, in red, or in turns with the right eye's.
    #[arg(long, value_enum, default_value_t = Stereo::None)]
    pub(crate) stereo: Stereo,

    /// Distance between the eyes, metres.
    #[arg(long, value_name = "M", default_value = "0.065", value_parser = spec::within(0.0..=1.0), allow_negative_numbers = true)]
    pub(crate) eye_distance: f64,

    /// Depth that both eyes see at the same place of their pictures, metres.
    #[arg(long, value_name = "M|inf", default_value = "inf", value_parser = spec::convergence, allow_negative_numbers = true)]
    pub(crate) convergence: f64,
}

/// From which side the volume is seen.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Camera")]
pub(crate) struct AimArgs {
    /// Turn of the eye about the vertical axis, degrees.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = spec::within(-36000.0..=36000.0), allow_negative_numbers = true)]
    pub(crate) azimuth: f64,

    /// Height of the eye above the horizon, degrees.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = spec::within(-90.0..=90.0), allow_negative_numbers = true)]
    pub(crate) elevation: f64,

    /// Which patient direction points up in the picture.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Up::S)]
    pub(crate) up: Up,
}

/// A patient direction by its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[value(rename_all = "UPPER")]
pub(crate) enum Up {
    /// Superior.
    S,
    /// Inferior.
    I,
    /// Anterior.
    A,
    /// Posterior.
    P,
    /// Left.
    L,
    /// Right.
    R,
}

impl Up {
    /// The direction that the letter stands for.
    pub(crate) fn direction(self) -> AnatomicalDirection {
        match self {
            Self::S => AnatomicalDirection::Superior,
            Self::I => AnatomicalDirection::Inferior,
            Self::A => AnatomicalDirection::Anterior,
            Self::P => AnatomicalDirection::Posterior,
            Self::L => AnatomicalDirection::Left,
            Self::R => AnatomicalDirection::Right,
        }
    }
}

/// How the eyes' pictures are arranged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Stereo {
    /// One eye in the middle.
    None,
    /// Left eye on the left.
    SideBySide,
    /// Left eye on top.
    TopBottom,
    /// Red for the left eye, cyan for the right one.
    Anaglyph,
    /// Both eyes in turns, as an animated GIF.
    Wobble,
    /// The left eye alone.
    Left,
    /// The right eye alone.
    Right,
}

impl Stereo {
    /// Whether both eyes' pictures are made.
    pub(crate) fn has_both_eyes(self) -> bool {
        match self {
            Self::SideBySide | Self::TopBottom | Self::Anaglyph | Self::Wobble => true,
            Self::None | Self::Left | Self::Right => false,
        }
    }

    /// Extension of the file that the picture is written to.
    pub(crate) fn extension(self) -> &'static str {
        if self == Self::Wobble { "gif" } else { "png" }
    }
}

impl AimArgs {
    /// Where the eye is at a distance, turned by a further azimuth.
    pub(crate) fn orbit(&self, turn_deg: f64, distance_m: f64) -> Orbit {
        Orbit {
            azimuth_rad: (self.azimuth + turn_deg).to_radians(),
            elevation_rad: self.elevation.to_radians(),
            distance_m,
        }
    }

    /// Where a volume stands in the world: its longest side is 1 m, its centre the origin.
    pub(crate) fn placement(&self, volume: &Volume) -> Placement {
        Placement::new(volume, world_from_patient(volume.grid(), self.up.direction()))
    }
}

impl CameraArgs {
    /// Refuses combinations that no picture can come from.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        if self.orthographic.is_some() && self.stereo != Stereo::None {
            return Err(Failure::input(
                "--stereo needs a perspective: it cannot be used with --orthographic",
            ));
        }
        Ok(())
    }

    /// The views of one picture, turned by a further azimuth.
    pub(crate) fn views(&self, turn_deg: f64) -> Result<Vec<View>, Failure> {
        let projection = match self.orthographic {
            Some(height_m) => Projection::Orthographic(
                OrthographicBox::from_height(height_m, self.size).map_err(Failure::input)?,
            ),
            None => Projection::Perspective(Frustum::from_fov(self.fov, self.size).map_err(Failure::input)?),
        };
        let middle = self.aim.orbit(turn_deg, self.distance).view(projection, self.size);
        let rig = match self.stereo {
            Stereo::None => Rig::Mono,
            _ => Rig::Stereo { eye_distance_m: self.eye_distance, convergence_m: self.convergence },
        };
        let views = rig.views(&middle);
        Ok(match self.stereo {
            Stereo::Left => views[..1].to_vec(),
            Stereo::Right => views[1..].to_vec(),
            _ => views,
        })
    }

    /// Puts the views' images into one picture.
    pub(crate) fn arrange(&self, images: &[&Image], background: [f32; 3]) -> Picture {
        let eyes: Vec<RgbImage> = images.iter().map(|image| image.over_background(background)).collect();
        match <[RgbImage; 2]>::try_from(eyes) {
            Ok([left, right]) => match self.stereo {
                Stereo::SideBySide => Picture::Still(left.beside(&right)),
                Stereo::TopBottom => Picture::Still(left.above(&right)),
                Stereo::Anaglyph => Picture::Still(left.anaglyph(&right)),
                Stereo::Wobble => Picture::Wobble([left, right]),
                Stereo::None | Stereo::Left | Stereo::Right => Picture::Still(left),
            },
            Err(mut eyes) => Picture::Still(eyes.swap_remove(0)),
        }
    }
}

/// How far the eye has turned in a picture of a turntable.
pub(crate) fn turn_deg(index: u32, frames: u32) -> f64 {
    360.0 / f64::from(frames) * f64::from(index)
}
