//! The full frame of a display of projectors, with and without regard to what it resolves (LF §4, Eq. 3 and 5).

use super::eyes::{self, Sight, Walk};
use crate::backend::{Engine, ResolvedShot, Shot, median, milliseconds};
use crate::failure::Failure;
use crate::progress::Bar;
use crate::skipping::Skipping;
use glam::{DAffine3, DVec3};
use serde_json::{Value, json};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::{Coarseness, ProjectorArray};
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::Gpu;

/// What is shown where.
pub(super) struct Stage<'a> {
    pub(super) volume: &'a Volume,
    pub(super) name: &'a str,
    pub(super) parameters: &'a CastParameters,
    pub(super) skipping: &'a Skipping,
    /// How the volume is turned.
    pub(super) turned: DAffine3,
    pub(super) array: &'a ProjectorArray,
    /// Whether it can be cast at the display's resolution.
    pub(super) has_levels: bool,
    pub(super) rounds: u32,
}

/// A full frame.
pub(super) struct FullFrame {
    pub(super) volume: String,
    pub(super) projectors: usize,
    pub(super) size: [u32; 2],
    pub(super) resolution: &'static str,
    coarseness: Coarseness,
    ms: f64,
    samples: u64,
    /// Over those at full resolution.
    of_full: f64,
    pub(super) sights: Vec<Sight>,
}

/// How it is cast, and what that takes.
struct Casts {
    resolution: &'static str,
    shot: Shot,
    coarseness: Coarseness,
    samples: u64,
    times_ms: Vec<f64>,
}

/// Length of the longest side of the volume as a part of the screen's height: it is in front of the screen and behind it by half of
/// that.
const SIZE_OF_SCREEN: f64 = 0.9;

/// The frame in full, and at the display's resolution if that can be.
pub(super) fn measure(stage: &Stage<'_>) -> Result<Vec<FullFrame>, Failure> {
    let description = stage.array.description();
    let volume_size_m = SIZE_OF_SCREEN * description.screen_size_m[1];
    let display_from_world = DAffine3::from_scale(DVec3::splat(volume_size_m)) * stage.turned;
    let views = stage.array.views(display_from_world);
    let coarser = if stage.has_levels { stage.volume.coarser_levels() } else { Vec::new() };
    let storage = StorageKind::lossless_for(stage.volume);
    let mut engine = Engine::gpu(Gpu::open_best()?, stage.volume, storage)?;
    engine.add_levels(&coarser)?;
    let full = engine.prepare(stage.parameters, stage.skipping)?;
    let of = |resolution, ResolvedShot { shot, coarseness }| Casts {
        resolution,
        shot,
        coarseness,
        samples: 0,
        times_ms: Vec::new(),
    };
    let mut casts = vec![of("full", ResolvedShot::in_full(full))];
    if stage.has_levels {
        let places = [display_from_world];
        let resolved = engine.prepare_resolved(stage.parameters, stage.skipping, stage.array, &places)?;
        casts.push(of("matched", resolved));
    }
    let title = format!("{}, {} projectors", stage.name, views.len());
    let bar = Bar::new(title, u64::from(stage.rounds) + 1);
    let mut pictures = Vec::new();
    for casts in &mut casts {
        let (images, samples) = pictured(&mut engine, casts.shot, &views)?;
        pictures.push(images);
        casts.samples = samples;
    }
    bar.advance();
    for _ in 0..stage.rounds {
        for casts in &mut casts {
            let mut all_ms = 0.0;
            for view in &views {
                all_ms += milliseconds(engine.cast(casts.shot, &[*view])?);
            }
            casts.times_ms.push(all_ms);
        }
        bar.advance();
    }
    drop(bar);
    let sights = eyes::sights(&mut engine, full, stage.array, display_from_world, &pictures)?;
    let samples_in_full = casts[0].samples;
    let frame = |(casts, sights): (Casts, _)| FullFrame {
        volume: stage.name.to_owned(),
        projectors: views.len(),
        size: description.image_size_px,
        resolution: casts.resolution,
        coarseness: casts.coarseness,
        ms: median(&casts.times_ms),
        samples: casts.samples,
        of_full: casts.samples as f64 / samples_in_full.max(1) as f64,
        sights,
    };
    Ok(casts.into_iter().zip(sights).map(frame).collect())
}

/// The images of all projectors before black, and how many samples they took.
fn pictured(engine: &mut Engine<'_>, shot: Shot, views: &[View]) -> Result<(Vec<RgbImage>, u64), Failure> {
    let (mut images, mut samples) = (Vec::with_capacity(views.len()), 0);
    for view in views {
        let (image, of_image) = engine.pictured(shot, view)?;
        samples += of_image;
        images.push(image);
    }
    Ok((images, samples))
}

impl FullFrame {
    fn mrays_per_s(&self) -> f64 {
        self.projectors as f64 * f64::from(self.size[0]) * f64::from(self.size[1]) / self.ms / 1e3
    }

    /// What eyes on a walk see, in its order.
    pub(super) fn on(&self, walk: Walk) -> impl Iterator<Item = &Sight> {
        self.sights.iter().filter(move |sight| sight.walk == walk)
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "projectors": self.projectors,
            "size": self.size,
            "resolution": self.resolution,
            "longest_step": self.coarseness.step_ratio(),
            "voxels_per_step": self.coarseness.voxels_per_step(),
            "ms_per_frame": self.ms,
            "mrays_per_s": self.mrays_per_s(),
            "samples": self.samples,
            "samples_of_full": self.of_full,
            "eyes": self.sights.iter().copied().map(Sight::to_json).collect::<Vec<_>>(),
        })
    }
}

pub(super) fn to_table(frames: &[FullFrame]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:>10} {:>9} {:<10} {:>4} {:>6} {:>10} {:>7} {:>10} {:>8}",
        "volume",
        "projectors",
        "size",
        "resolution",
        "step",
        "voxels",
        "ms",
        "Mray/s",
        "M samples",
        "of full"
    )];
    for frame in frames {
        lines.push(format!(
            "{:<14} {:>10} {:>9} {:<10} {:>4} {:>6} {:>10.1} {:>7.1} {:>10.2} {:>8.3}",
            frame.volume,
            frame.projectors,
            format!("{}x{}", frame.size[0], frame.size[1]),
            frame.resolution,
            frame.coarseness.step_ratio(),
            frame.coarseness.voxels_per_step(),
            frame.ms,
            frame.mrays_per_s(),
            frame.samples as f64 / 1e6,
            frame.of_full,
        ));
    }
    lines.join("\n")
}
