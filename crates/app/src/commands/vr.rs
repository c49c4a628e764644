//! `vr`: a volume in a headset.

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::layering::LayeringArgs;
use crate::output::{check_apart, print, print_json};
use crate::progress::Bar;
use crate::spec;
use crate::transfer_spec;
use crate::viewer::Source;
use crate::viewer::command::Command;
use crate::viewer::loading::{Arrived, Destination};
use crate::viewer::session::{Session, Showing};
use crate::viewer::state::{Edit, EyeMethod, Layers, WarpName};
use crate::volume_args::RawArgs;
use crate::vr::{
    Beside, Checking, Clock, Connected, Control, DepthLayer, Guided, Mirror, OfPictures, OpenXr, Opening,
    Played, Record, Replay, Room, load, run as show,
};
use anyhow::Context as _;
use clap::{Args, ValueEnum};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use wheatstone_core::head::Display;
use wheatstone_core::headset::{Demonstration, Recording, Scale, Stand};
use wheatstone_render::Gpu;

/// Width and height of the mirror window, points.
const MIRROR: [u32; 2] = [960, 640];

/// One of so many refreshes is compared where nothing else is asked for.
pub(super) const CHECK_EVERY: u64 = 20;

/// Width and height of each eye's picture without a headset, pixels.
pub(super) const EYE: &str = "640x720";

/// Show a volume in a headset: walk around it, take it in your hands, scale it, cut it.
///
/// An OpenXR runtime shows the pictures. The squeeze of one hand carries the volume, of both hands scales it; the trigger drags the face
/// of the visible box or the clip plane that the hand points at; a bare hand does both by pinching; the thumb-stick goes through transfer functions (left, right) and shifts
/// the window (up, down). What the volume costs does not matter: it is cast a few cells per refresh, and the newest whole picture is
/// warped to where the eyes are. It ends when the window beside the headset is closed, at Ctrl-C, or when the runtime ends it.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone vr\n  \
    wheatstone vr head.nii.gz --tf ct-bone --life-size\n  \
    wheatstone vr saved.json --floor --record session.jsonl\n  \
    wheatstone vr head.nii.gz --replay session.jsonl --headset none --json")]
pub(crate) struct VrArgs {
    /// Volume or saved view (.json) [default: the brain that ships with Wheatstone].
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,

    /// Transfer function at first: a preset's name, auto, a file.
    #[arg(long, value_name = "SPEC", value_parser = checked_transfer)]
    tf: Option<String>,

    /// A millimetre of the patient is a millimetre; else the longest side is as long as what two hands hold.
    #[arg(long)]
    life_size: bool,

    /// Show the floor and the horizon.
    #[arg(long)]
    floor: bool,

    /// How the newest whole picture is brought to where the eyes are; a refresh that has no time for it takes a cheaper one.
    #[arg(long, value_enum, default_value_t = WarpName::Volumetric)]
    warp: WarpName,

    /// What shows the pictures.
    #[arg(long, value_enum, default_value_t = HeadsetName::Openxr)]
    headset: HeadsetName,

    /// Play eyes and hands of a recording.
    #[arg(long, value_name = "FILE.jsonl")]
    replay: Option<PathBuf>,

    /// Record eyes and hands to a file.
    #[arg(long, value_name = "FILE.jsonl")]
    record: Option<PathBuf>,

    /// Open no window beside the headset.
    #[arg(long)]
    no_mirror: bool,

    #[command(flatten)]
    pictures: PicturesArgs,

    /// Print what was measured as one JSON object when it ends.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    raw: RawArgs,
}

/// How refreshes are drawn, how many, and which are compared.
#[derive(Debug, Args)]
pub(super) struct PicturesArgs {
    /// End after so many refreshes.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) refreshes: Option<u64>,

    /// Without a headset, draw one refresh after the other as fast as it goes: the clock is simulated, and none is left out.
    #[arg(long)]
    patient: bool,

    /// Width and height of the eyes' pictures, as parts of what the headset's software recommends [default: 1; on software Vulkan as
    /// much as there is time for].
    #[arg(long, value_name = "PART", value_parser = spec::within(0.1..=4.0), allow_negative_numbers = true)]
    image_scale: Option<f64>,

    #[command(flatten)]
    layering: LayeringArgs,

    /// Where the eyes' pictures come from; canted displays need two casts, and get them [default: as a saved view says, else
    /// two-casts].
    #[arg(long, value_enum)]
    eye_method: Option<EyeMethod>,

    /// Give the runtime the depths of first hits along with pictures, by which it moves them to a pose that is newer still: it takes
    /// them for surfaces, which harms translucent volumes.
    #[arg(long)]
    depth_layer: bool,

    #[command(flatten)]
    pub(super) check: CheckArgs,
}

impl PicturesArgs {
    /// What flags ask for, whatever a saved view says.
    pub(super) fn commands(&self) -> Result<impl Iterator<Item = Command>, Failure> {
        let layers = Layers::from(&self.layering.resolve()?);
        let layers = self.layering.is_given().then_some(Edit::Layers(layers).into());
        Ok(layers.into_iter().chain(self.eye_method.map(|method| Edit::EyeMethod(method).into())))
    }

    /// Refuses what would be without effect.
    pub(super) fn check(&self, headset: HeadsetName) -> Result<(), Failure> {
        match headset {
            HeadsetName::Openxr if self.patient => {
                Err(Failure::input("--patient needs --headset none: a headset waits for nobody"))
            }
            HeadsetName::None if self.image_scale.is_some() => {
                Err(Failure::input("--image-scale needs --headset openxr: nothing is recommended without"))
            }
            _ => Ok(()),
        }
    }

    /// When refreshes come without a headset.
    pub(super) fn clock(&self) -> Clock {
        if self.patient { Clock::Patient } else { Clock::Real }
    }

    /// What a runtime is to take, read where refreshes are compared.
    pub(super) fn of_pictures(&self, checks: Option<&Checking>) -> OfPictures {
        let is_read = checks.is_some();
        OfPictures { depth_layer: self.depth_layer(), image_scale: self.image_scale, is_read }
    }

    /// Whether depths are given along with pictures.
    pub(super) fn depth_layer(&self) -> DepthLayer {
        if self.depth_layer { DepthLayer::With } else { DepthLayer::Without }
    }
}

/// When what is shown is compared with direct renders from where the eyes were, after all is over.
#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// Compare what is shown every so many refreshes [default: vr: never, or 20 with --check-pictures; bench vr: 20].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    check_every: Option<u64>,

    /// Compare at most so many refreshes.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u16).range(1..=1000))]
    checks: u16,

    /// Write what each eye was shown at refreshes that are compared to a folder.
    #[arg(long, value_name = "DIR")]
    check_pictures: Option<PathBuf>,
}

impl CheckArgs {
    /// As asked for, or else one refresh of so many.
    pub(super) fn checking(&self, every: Option<u64>) -> Option<Checking> {
        let for_pictures = self.check_pictures.as_ref().map(|_| CHECK_EVERY);
        let every = self.check_every.or(every).or(for_pictures)?;
        Some(Checking { every, most: self.checks.into(), pictures: self.check_pictures.clone() })
    }
}

/// What shows pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum HeadsetName {
    /// The headset of the OpenXR runtime that the system has set up.
    Openxr,
    /// None: eyes and hands of a recording, or of a demonstration, at a simulated display of 90 Hz.
    None,
}

/// Runs the command.
pub(crate) fn run(args: &VrArgs) -> Result<(), Failure> {
    let source = Source { file: args.file.clone(), layout: args.raw.layout() };
    let mut commands: Vec<Command> = vec![Edit::Warp(args.warp).into()];
    commands.extend(args.pictures.commands()?);
    commands.extend(args.tf.clone().map(Command::Preset));
    args.pictures.check(args.headset)?;
    check_apart(&args.record, args.replay.as_deref().into_iter().chain(args.file.as_deref()))?;
    let record = args.record.as_deref().map(Record::begin).transpose()?;
    let mut company = Company { mirror: None, record, interrupt: Interrupt::default() };
    let recording = args.replay.as_deref().map(read_recording).transpose()?;
    let scale = if args.life_size { Scale::True } else { Scale::Human };
    let checks = args.pictures.check.checking(None);
    let opening = |(session, arrived): (Session, _), stand, control| Opening {
        session,
        arrived,
        commands,
        control,
        scale,
        stand,
        has_floor: args.floor,
        checks: checks.clone(),
        refreshes: args.pictures.refreshes,
    };
    let shown = match args.headset {
        HeadsetName::None => {
            let gpu = Arc::new(Gpu::open_best()?);
            let loaded = open(source, &gpu)?;
            let (played, stand) = played(recording, &loaded.1);
            let display = Display::default();
            let size = spec::picture_size(EYE).map_err(Failure::input)?;
            let mut headset =
                Replay::new(gpu, played, display, args.pictures.clock(), size, args.pictures.depth_layer())?;
            company.interrupt.watch()?;
            show(&mut headset, opening(loaded, stand, Control::Hands), &mut company)
        }
        HeadsetName::Openxr => {
            check_readable(args.file.as_deref())?;
            let connected = Connected::connect()?;
            let loaded = open(source, connected.gpu())?;
            if !args.no_mirror {
                company.mirror = mirror(&connected);
            }
            let control = if company.mirror.is_some() { Control::HandsAndWindow } else { Control::Hands };
            let headset = OpenXr::begin(connected, args.pictures.of_pictures(checks.as_ref()))?;
            company.interrupt.watch()?;
            match recording.map(Played::Recording) {
                Some(played) => {
                    show(&mut Guided::new(headset, played), opening(loaded, None, control), &mut company)
                }
                None => show(&mut { headset }, opening(loaded, None, control), &mut company),
            }
        }
    };
    // However it ended, what was recorded until then is kept.
    let recorded = company.record.map_or(Ok(()), Record::finish);
    let report = shown?;
    recorded?;
    if args.json {
        print_json(&report.to_json())?;
    } else {
        print(&report.to_lines())?;
    }
    Ok(())
}

/// A window beside the headset, if there is a display; what is in its way is told.
fn mirror(connected: &Connected) -> Option<Mirror> {
    match Mirror::open(Arc::clone(connected.gpu()), connected.instance().clone(), MIRROR) {
        Ok(mirror) => Some(mirror),
        Err(failure) => {
            eprintln!("no window beside the headset: {failure}");
            None
        }
    }
}

/// Reads and uploads what is to be shown at first, before a session begins that has no time for it.
pub(super) fn open(source: Source, gpu: &Arc<Gpu>) -> Result<(Session, (Box<Arrived>, Showing)), Failure> {
    let _spinner = Bar::spinner("reading the volume");
    let mut session = Session::begin(source, Arc::new(|| ()), Destination::Headset)?;
    let arrived = load(&mut session, gpu)?;
    Ok((session, arrived))
}

/// A recording, or the demonstration with its own beginning.
pub(super) fn played(
    recording: Option<Recording>,
    (arrived, showing): &(Box<Arrived>, Showing),
) -> (Played, Option<Stand>) {
    match recording {
        Some(recording) => (Played::Recording(recording), None),
        None => {
            let up = showing.state.look.up.direction();
            let demonstration = Demonstration::new(&arrived.facts.grid, up);
            let stand = *demonstration.stand();
            (Played::Demonstration(Box::new(demonstration)), Some(stand))
        }
    }
}

/// A file that is not there is told before a runtime that is not.
pub(super) fn check_readable(path: Option<&Path>) -> Result<(), Failure> {
    path.map_or(Ok(()), |path| opened(path).map(drop))
}

fn opened(path: &Path) -> Result<File, Failure> {
    File::open(path).with_context(|| format!("{}", path.display())).map_err(Failure::Input)
}

pub(super) fn read_recording(path: &Path) -> Result<Recording, Failure> {
    let recording = Recording::read(BufReader::new(opened(path)?));
    recording.with_context(|| format!("{}", path.display())).map_err(Failure::Input)
}

pub(super) fn checked_transfer(text: &str) -> Result<String, String> {
    transfer_spec::parse(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

/// A mirror and a recording, if they are wanted, and what ends it all.
struct Company {
    mirror: Option<Mirror>,
    record: Option<Record>,
    interrupt: Interrupt,
}

impl Beside for Company {
    fn refreshed(&mut self, room: &mut Room) -> Result<(), Failure> {
        if let Some(record) = &mut self.record {
            record.refreshed(room)?;
        }
        self.mirror.as_mut().map_or(Ok(()), |mirror| mirror.refreshed(room))
    }

    fn has_quit(&self) -> bool {
        self.interrupt.has_come() || self.mirror.as_ref().is_some_and(Mirror::has_quit)
    }
}
