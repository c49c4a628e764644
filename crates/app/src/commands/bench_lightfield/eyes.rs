//! Eyes before a display of projectors: how far what they see is from what there would be to see, at the place that the display is
//! made for and around it (LF §4: a good approximation elsewhere).

use super::full_frame::FullFrame;
use crate::backend::{Engine, Shot};
use crate::failure::Failure;
use crate::progress::Bar;
use glam::{DAffine3, DVec3};
use serde_json::{Value, json};
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::ProjectorArray;
use wheatstone_core::lightfield::simulator::Eye;
use wheatstone_core::metrics::compare;

/// A straight way of an eye through the virtual viewer's place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Walk {
    /// Upwards.
    Up,
    /// To the right.
    Sideways,
    /// Away from the screen.
    Away,
}

/// What an eye sees of a full frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    pub(super) walk: Walk,
    pub(super) eye_m: DVec3,
    /// From what there would be to see.
    pub(super) dssim: f64,
    /// From the most that the display's beams can show of that.
    dssim_of_beams: f64,
}

/// How far eyes go up and down, metres.
const UP_M: f64 = 0.1;

/// How far they go to the sides, metres.
const SIDEWAYS_M: f64 = 0.2;

/// How much further away from the screen they go than the virtual viewer is, and by how much nearer, as factors.
const AWAY: f64 = 2.0;

/// Rays of each beam of what the display can show at most.
const BEAM_RAYS: u32 = 16;

/// Places on a walk from its middle to either end.
const STEPS: i32 = 5;

impl Walk {
    pub(super) const ALL: [Self; 3] = [Self::Up, Self::Sideways, Self::Away];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Sideways => "sideways",
            Self::Away => "away",
        }
    }

    /// How far an eye is along it, cm: from the middle of the screen.
    pub(super) fn along_cm(self, eye_m: DVec3) -> f64 {
        100.0
            * match self {
                Self::Up => eye_m.y,
                Self::Sideways => eye_m.x,
                Self::Away => eye_m.z,
            }
    }

    /// Places from one end to the other.
    fn places_m(self, viewer_m: DVec3) -> impl Iterator<Item = DVec3> {
        (-STEPS..=STEPS).map(move |step| {
            let share = f64::from(step) / f64::from(STEPS);
            match self {
                Self::Up => viewer_m + DVec3::Y * (UP_M * share),
                Self::Sideways => viewer_m + DVec3::X * (SIDEWAYS_M * share),
                Self::Away => viewer_m.with_z(viewer_m.z * AWAY.powf(share)),
            }
        })
    }
}

/// What eyes see of frames that show the same volume, each of one image for each projector: for each frame the sights of all walks.
pub(super) fn sights(
    engine: &mut Engine<'_>,
    shot: Shot,
    array: &ProjectorArray,
    display_from_world: DAffine3,
    frames: &[Vec<RgbImage>],
) -> Result<Vec<Vec<Sight>>, Failure> {
    let description = array.description();
    let bar = Bar::new("eyes", Walk::ALL.len() as u64 * (2 * STEPS as u64 + 1));
    let mut sights = vec![Vec::new(); frames.len()];
    for walk in Walk::ALL {
        for eye_m in walk.places_m(array.virtual_viewer_m()) {
            let eye = Eye::new(eye_m, description.image_size_px).map_err(Failure::input)?;
            let view = |moved| eye.view(description.screen_size_m, moved * display_from_world);
            let truth = engine.truth(shot, &view(DAffine3::IDENTITY))?;
            let beams = engine.mean(shot, array.resolution().beam(BEAM_RAYS).map(view))?;
            for (images, sights) in frames.iter().zip(&mut sights) {
                let seen = array.seen_from(&eye, images).map_err(Failure::input)?;
                let off =
                    |truth| compare(&seen, truth).map(|quality| quality.dssim()).map_err(Failure::input);
                let (dssim, dssim_of_beams) = (off(&truth)?, off(&beams)?);
                sights.push(Sight { walk, eye_m, dssim, dssim_of_beams });
            }
            bar.advance();
        }
    }
    Ok(sights)
}

impl Sight {
    pub(super) fn to_json(self) -> Value {
        json!({ "walk": self.walk.name(), "eye_m": self.eye_m.to_array(), "dssim": self.dssim, "dssim_of_beams": self.dssim_of_beams })
    }
}

/// The error where each walk begins, at the virtual viewer's place in its middle, and where it ends.
pub(super) fn to_table(frames: &[FullFrame]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:<10} {:<8} {:>8} {:>8} {:>8} {:>11} {:>10} {:>10} {:>10}",
        "volume",
        "resolution",
        "eye goes",
        "from cm",
        "by cm",
        "to cm",
        "DSSIM there",
        "there",
        "of beams",
        "there"
    )];
    for (frame, walk) in frames.iter().flat_map(|frame| Walk::ALL.map(|walk| (frame, walk))) {
        let sights: Vec<&Sight> = frame.on(walk).collect();
        let [from, by, to] = [0, STEPS as usize, 2 * STEPS as usize].map(|place| sights[place]);
        let [from_cm, by_cm, to_cm] = [from, by, to].map(|sight| walk.along_cm(sight.eye_m));
        lines.push(format!(
            "{:<14} {:<10} {:<8} {from_cm:>8.1} {by_cm:>8.1} {to_cm:>8.1} {:>11.5} {:>10.5} {:>10.5} {:>10.5}",
            frame.volume,
            frame.resolution,
            walk.name(),
            from.dssim,
            by.dssim,
            by.dssim_of_beams,
            to.dssim,
        ));
    }
    lines.join("\n")
}
