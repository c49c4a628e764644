//! The full frame of a display of projectors, with and without regard to what it resolves (LF §4, Eq. 3 and 5).

use crate::backend::{Engine, median, milliseconds};
use crate::failure::Failure;
use crate::progress::Bar;
use crate::skipping::Skipping;
use glam::{DAffine3, DVec3};
use serde_json::{Value, json};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::lightfield::{ProjectorArray, Resolution};
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
    /// How many times smaller the sides of pictures are than the display's.
    pub(super) scale: u32,
    pub(super) rounds: u32,
}

/// A full frame.
pub(super) struct FullFrame {
    volume: String,
    projectors: usize,
    size: [u32; 2],
    is_matched: bool,
    ms: f64,
    samples: u64,
}

/// Length of the longest side of the volume as a part of the screen's height: it is in front of the screen and behind it by half of
/// that.
const SIZE_OF_SCREEN: f64 = 0.9;

/// Both frames in turn.
pub(super) fn measure(stage: &Stage<'_>) -> Result<Vec<FullFrame>, Failure> {
    let description = stage.array.description();
    let size = description.image_size_px.map(|side| (side / stage.scale).max(1));
    let volume_size_m = SIZE_OF_SCREEN * description.screen_size_m[1];
    let display_from_world = DAffine3::from_scale(DVec3::splat(volume_size_m)) * stage.turned;
    let views: Vec<View> =
        stage.array.views(display_from_world).into_iter().map(|view| View { size, ..view }).collect();
    let coarser = stage.volume.coarser_levels();
    let storage = StorageKind::lossless_for(stage.volume);
    let mut engine = Engine::gpu(Gpu::open_best()?, stage.volume, storage)?;
    engine.add_levels(&coarser)?;
    // Pixels that are larger on the screen resolve as much less.
    let resolution = Resolution {
        pixel_size_m: description.pixel_size_m * f64::from(stage.scale),
        beam_angle_rad: description.beam_angle_deg.to_radians(),
    };
    let plain = engine.prepare(stage.parameters, stage.skipping)?;
    let resolved = LevelOfDetail::Resolved(resolution);
    let matched = engine.prepare_detail(stage.parameters, stage.skipping, resolved)?;
    let mut frames = [(plain, false), (matched, true)].map(|(shot, is_matched)| {
        let frame = FullFrame {
            volume: stage.name.to_owned(),
            projectors: views.len(),
            size,
            is_matched,
            ms: 0.0,
            samples: 0,
        };
        (shot, frame, Vec::new())
    });
    let bar = Bar::new(format!("{}, {} projectors", stage.name, views.len()), u64::from(stage.rounds) + 1);
    for (shot, frame, _) in &mut frames {
        for view in &views {
            engine.cast(*shot, &[*view])?;
            frame.samples += engine.read()?.iter().map(|cast| cast.samples).sum::<u64>();
        }
    }
    bar.advance();
    for _ in 0..stage.rounds {
        for (shot, _, times_ms) in &mut frames {
            let mut all_ms = 0.0;
            for view in &views {
                all_ms += milliseconds(engine.cast(*shot, &[*view])?);
            }
            times_ms.push(all_ms);
        }
        bar.advance();
    }
    Ok(frames.into_iter().map(|(_, frame, times_ms)| FullFrame { ms: median(&times_ms), ..frame }).collect())
}

impl FullFrame {
    fn mrays_per_s(&self) -> f64 {
        self.projectors as f64 * f64::from(self.size[0]) * f64::from(self.size[1]) / self.ms / 1e3
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "projectors": self.projectors,
            "size": self.size,
            "resolution_matched": self.is_matched,
            "ms_per_frame": self.ms,
            "mrays_per_s": self.mrays_per_s(),
            "samples": self.samples,
        })
    }
}

pub(super) fn to_table(frames: &[FullFrame]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:>10} {:>9} {:<10} {:>10} {:>7} {:>10}",
        "volume", "projectors", "size", "resolution", "ms", "Mray/s", "M samples"
    )];
    for frame in frames {
        lines.push(format!(
            "{:<14} {:>10} {:>9} {:<10} {:>10.1} {:>7.1} {:>10.2}",
            frame.volume,
            frame.projectors,
            format!("{}x{}", frame.size[0], frame.size[1]),
            if frame.is_matched { "matched" } else { "ignored" },
            frame.ms,
            frame.mrays_per_s(),
            frame.samples as f64 / 1e6,
        ));
    }
    lines.join("\n")
}
