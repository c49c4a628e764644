//! `view`: a volume in a window.

use crate::failure::Failure;
use crate::layering::LayeringArgs;
use crate::output::print_json;
use crate::spec;
use crate::text_file::read_text_file;
use crate::viewer::state::{Arrangement, Calibration, Edit, Layers, ShownDisplay};
use crate::viewer::{Opening, Player, Source, random_steps, read_steps, run_headless, run_window};
use crate::volume_args::RawArgs;
use anyhow::anyhow;
use clap::Args;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use wheatstone_render::GpuError;

/// Show a volume in a window: look around, edit its transfer function, cut it.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone view\n  \
    wheatstone view head.nii.gz\n  \
    wheatstone view saved.json\n  \
    wheatstone view head.nii.gz --display go\n  \
    wheatstone view head.nii.gz --display portrait --interlace visual.json\n  \
    wheatstone view head.nii.gz --script session.jsonl --json\n  \
    xvfb-run wheatstone view --soak 60 --seed 1 --json\n\n\
    Press ? in the window for the keys.")]
pub(crate) struct ViewArgs {
    /// Volume or saved view (.json) [default: the brain that ships with Wheatstone].
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,

    /// Width and height of the window, points.
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = spec::window_size)]
    size: [u32; 2],

    /// Play the events of a file: one JSON value a line.
    #[arg(long, value_name = "FILE.jsonl")]
    script: Option<PathBuf>,

    /// Play random events for so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..=86_400), conflicts_with = "script")]
    soak: Option<u64>,

    /// Which random events.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "soak")]
    seed: u64,

    /// Open no window; events come from --script or --soak alone.
    #[arg(long)]
    headless: bool,

    /// Print what was measured as one JSON object when the viewer ends.
    #[arg(long)]
    json: bool,

    /// Show the volume on a light-field display: portrait, go, 16, 32, 65, 16-landscape, 16-portrait, 32-landscape, 32-portrait,
    /// agus-2008 or a description.
    #[arg(long, value_name = "NAME|FILE.json")]
    display: Option<String>,

    /// Show the picture for the panel of the display behind lenses, by its calibration (visual.json) [display: portrait].
    #[arg(long, value_name = "CALIBRATION.json")]
    interlace: Option<PathBuf>,

    #[command(flatten)]
    layering: LayeringArgs,

    #[command(flatten)]
    raw: RawArgs,
}

/// Most bytes of a calibration.
const MOST_BYTES: u64 = 1 << 22;

/// Runs the command.
pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    let begun = Instant::now();
    let player = args.player()?;
    if args.headless && player.is_none() {
        return Err(Failure::input("--headless needs --script or --soak"));
    }
    let is_played = player.is_some();
    let source = Source { file: args.file.clone(), layout: args.raw.layout() };
    let opening = Opening { source, edits: args.edits()?, player, size: args.size, begun };
    let shown = if args.headless { run_headless(opening) } else { run_window(opening) };
    let report = shown.map_err(with_way_out)?;
    if args.json {
        print_json(&report.to_json())?;
    }
    match report.failures.first() {
        Some(failure) if is_played => Err(Failure::Internal(anyhow!("{failure}"))),
        _ => Ok(()),
    }
}

/// Without an adapter there is no window, but there are pictures.
fn with_way_out(failure: Failure) -> Failure {
    match failure {
        Failure::Gpu(error @ GpuError::NoAdapter { .. }) => Failure::Internal(anyhow!(
            "{error}, or make pictures without an adapter: `wheatstone render` casts them on the CPU"
        )),
        other => other,
    }
}

impl ViewArgs {
    /// What flags say of what is shown, whatever a saved view says.
    fn edits(&self) -> Result<Vec<Edit>, Failure> {
        let layers = Layers::from(&self.layering.resolve()?);
        let layers = self.layering.is_given().then_some(Edit::Layers(layers));
        Ok(layers.into_iter().chain(self.edits_of_display()?).collect())
    }

    fn edits_of_display(&self) -> Result<Vec<Edit>, Failure> {
        let mut edits = Vec::new();
        if let Some(name) = &self.display {
            edits.push(Edit::Display(ShownDisplay::named(name)?));
            edits.push(Edit::Arrangement(Arrangement::LightField));
        }
        if let Some(path) = &self.interlace {
            let calibration =
                read_text_file(path, MOST_BYTES, "a calibration", Calibration::from_visual_json)?;
            edits.push(Edit::Calibration(Some(calibration)));
            edits.push(Edit::Arrangement(Arrangement::Panel));
        }
        Ok(edits)
    }

    fn player(&self) -> Result<Option<Player>, Failure> {
        Ok(match (&self.script, self.soak) {
            (Some(path), _) => Some(Player::new(read_steps(path)?.into_iter())),
            (None, Some(seconds)) => Some(Player::new(random_steps(self.seed, Duration::from_secs(seconds)))),
            (None, None) => None,
        })
    }
}
