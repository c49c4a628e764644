//! `bench vr`: how well refreshes of a headset are kept, and how far what they show is from what they should.

use super::vr::{
    CHECK_EVERY, EYE, HeadsetName, PicturesArgs, check_readable, checked_transfer, open, played,
    read_recording,
};
use crate::failure::Failure;
use crate::output::{file_in, print, print_json};
use crate::spec;
use crate::viewer::Source;
use crate::viewer::command::Command;
use crate::viewer::state::{Edit, WarpName};
use crate::vr::{
    Beside, Checking, Connected, Control, Guided, OpenXr, Opening, Replay, Report, Room, run as show,
};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use wheatstone_core::head::Display;
use wheatstone_core::headset::Scale;
use wheatstone_core::scene::Shading;
use wheatstone_render::Gpu;

/// Refreshes that are kept by a headset, while a head sways and hands take hold of the volume.
///
/// Each volume is played a recording, or a demonstration of ten seconds: the volume is carried, scaled, cropped, and shown by the next
/// preset. What is shown at some refreshes is compared with direct renders from where the eyes were then, when all is over.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench vr bonsai.nii.gz\n  \
    wheatstone bench vr bonsai.nii.gz --warps volumetric,grid --refresh-hz 30 --json\n  \
    wheatstone bench vr bonsai.nii.gz --headset openxr --replay session.jsonl")]
pub(crate) struct VrBenchArgs {
    /// Volume files.
    #[arg(value_name = "FILE", required = true)]
    volumes: Vec<PathBuf>,

    /// Transfer function.
    #[arg(long, value_name = "SPEC", value_parser = checked_transfer)]
    tf: Option<String>,

    /// Shading.
    #[arg(long, value_name = "SHADING", default_value = "none", value_parser = spec::shading)]
    shading: Shading,

    /// Warps that are asked for; a refresh that has no time for one takes a cheaper one.
    #[arg(long, value_name = "WARPS", value_enum, value_delimiter = ',', default_value = "volumetric")]
    warps: Vec<WarpName>,

    /// Eyes and hands [default: a demonstration].
    #[arg(long, value_name = "FILE.jsonl")]
    replay: Option<PathBuf>,

    /// What shows the pictures.
    #[arg(long, value_enum, default_value_t = HeadsetName::None)]
    headset: HeadsetName,

    /// Width and height of each eye's picture without a headset, pixels.
    #[arg(long, value_name = "WxH", default_value = EYE, value_parser = spec::picture_size)]
    size: [u32; 2],

    /// Refreshes per second without a headset.
    #[arg(long, value_name = "HZ", default_value_t = 90.0, value_parser = spec::within(1.0..=1000.0), allow_negative_numbers = true)]
    refresh_hz: f64,

    #[command(flatten)]
    pictures: PicturesArgs,

    /// Print one JSON object on standard output instead of lines.
    #[arg(long)]
    json: bool,
}

/// Nothing goes on beside.
struct Nothing;

impl Beside for Nothing {
    fn refreshed(&mut self, _: &mut Room) -> Result<(), Failure> {
        Ok(())
    }

    fn has_quit(&self) -> bool {
        false
    }
}

/// Runs the command.
pub(crate) fn run(args: &VrBenchArgs) -> Result<(), Failure> {
    args.pictures.check(args.headset)?;
    let mut reports = Vec::new();
    for volume in &args.volumes {
        for &warp in &args.warps {
            reports.push((warp, args.measure(volume, warp)?));
        }
    }
    if args.json {
        let rows: Vec<_> = reports
            .iter()
            .map(|(warp, report)| {
                let mut row = report.to_json();
                row["warp"] = json!(warp.name());
                row
            })
            .collect();
        return print_json(
            &json!({ "device": reports.first().map(|(_, report)| &report.device), "rows": rows }),
        );
    }
    let lines: Vec<_> =
        reports.iter().map(|(warp, report)| format!("{}: {}", warp.name(), report.to_lines())).collect();
    print(&lines.join("\n\n"))
}

impl VrBenchArgs {
    fn measure(&self, volume: &std::path::Path, warp: WarpName) -> Result<Report, Failure> {
        let source = Source { file: Some(volume.to_owned()), layout: None };
        let recording = self.replay.as_deref().map(read_recording).transpose()?;
        let mut commands: Vec<Command> = vec![Edit::Warp(warp).into(), Edit::Shading(self.shading).into()];
        commands.extend(self.pictures.commands()?);
        commands.extend(self.tf.clone().map(Command::Preset));
        let checks = self.pictures.check.checking(Some(CHECK_EVERY)).map(|checking| {
            let row = format!("{}_{}", volume.file_stem().unwrap_or_default().display(), warp.name());
            Checking { pictures: checking.pictures.map(|folder| file_in(&folder, &row)), ..checking }
        });
        let opening = |(session, arrived), stand| Opening {
            session,
            arrived,
            commands,
            control: Control::Hands,
            scale: Scale::Human,
            stand,
            has_floor: false,
            checks: checks.clone(),
            refreshes: self.pictures.refreshes,
        };
        match self.headset {
            HeadsetName::None => {
                let gpu = Arc::new(Gpu::open_best()?);
                let loaded = open(source, &gpu)?;
                let (played, stand) = played(recording, &loaded.1);
                let display = Display::new(self.refresh_hz).map_err(Failure::input)?;
                let mut headset = Replay::new(
                    gpu,
                    played,
                    display,
                    self.pictures.clock(),
                    self.size,
                    self.pictures.depth_layer(),
                )?;
                show(&mut headset, opening(loaded, stand), &mut Nothing)
            }
            HeadsetName::Openxr => {
                check_readable(Some(volume))?;
                let connected = Connected::connect()?;
                let loaded = open(source, connected.gpu())?;
                let (played, stand) = played(recording, &loaded.1);
                let session = OpenXr::begin(connected, self.pictures.of_pictures(checks.as_ref()))?;
                let mut headset = Guided::new(session, played);
                show(&mut headset, opening(loaded, stand), &mut Nothing)
            }
        }
    }
}
