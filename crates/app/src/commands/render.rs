//! `render`: a volume file to a picture.

use crate::backend::{
    BackendChoice, Engine, GradientMapSize, Job, Leaping, Shot, Underived, make_on, median, milliseconds,
};
use crate::camera::{CameraArgs, Stereo, turn_deg};
use crate::failure::Failure;
use crate::heat_map::{heat_map, most_reads};
use crate::look::{Look, LookArgs, ModeName};
use crate::output::{check_apart, check_writable, described, numbered, print_json};
use crate::pairing::{PairArgs, PairRequest, Pairing};
use crate::picture::{Bits, Picture};
use crate::progress::Bar;
use crate::skipping::{SkipArgs, SkipName, Skipping};
use crate::spec::{self, Show};
use crate::volume_args::VolumeArgs;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::image::Image;
use wheatstone_core::volume::Volume;
use wheatstone_io::Loaded;

/// Render a volume to a PNG picture, for one eye or two.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone render head.nii.gz -o head.png\n  \
    wheatstone render head.nii.gz -o head.png --tf mri-brain-t1 --shading phong --azimuth 30\n  \
    wheatstone render ct.nrrd -o ct.png --tf ct-bone --stereo side-by-side --size 1024x1024\n  \
    wheatstone render ct.nrrd -o wobble.gif --tf ct-bone --stereo wobble --stereo-method strips --convergence 1.7\n  \
    wheatstone render ct.nrrd -o mip.png --mode mip --window -100..400 --up A\n  \
    wheatstone render bonsai_256x256x256_uint8.raw -o b.png --tf ramp:0.15..1 --ert 0 --json\n  \
    wheatstone render scan.raw --raw-size 64x64x32 --raw-type int16 -o scan.png --iso 0.4\n  \
    wheatstone render head.nii.gz -o turn.png --turntable 36\n  \
    wheatstone render head.nii.gz -o reads.png --ert 0 --skip distance --block-size 4 --show samples\n\n\
    --tf, --iso, V and G are normalised: 0 and 1 are the ends of the window. docs/cli.md tells which window counts.")]
pub(crate) struct RenderArgs {
    /// The PNG file to write; the GIF file for --stereo wobble.
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,

    /// Colour behind the volume.
    #[arg(long, value_name = "RRGGBB", default_value = "000000", value_parser = spec::color)]
    background: [f32; 3],

    /// Bits per channel of the PNG file.
    #[arg(long, value_enum, default_value = "8")]
    bits: Bits,

    /// What casts the rays.
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,

    /// Time so many frames after a warm-up frame.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000), conflicts_with = "turntable", allow_negative_numbers = true)]
    frames: Option<u32>,

    /// Write N pictures, numbered from 0000 before the extension, turning by 360/N degrees from one to the next.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    turntable: Option<u32>,

    /// What to write: picture, or samples: how much each ray has read, black for nothing and white for the most of any
    /// picture of a turntable, or for N (samples:N).
    #[arg(long, value_name = "WHAT", default_value = "picture", value_parser = spec::show)]
    show: Show,

    /// Cast what is far away of coarser voxels by longer steps, each about so many pixels wide (dvr, one-dimensional functions).
    #[arg(long, value_name = "PIXELS", num_args = 0..=1, require_equals = true, default_missing_value = "1", value_parser = spec::within(0.1..=100.0), allow_negative_numbers = true)]
    level_of_detail: Option<f64>,

    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    camera: CameraArgs,

    #[command(flatten)]
    pair: PairArgs,

    #[command(flatten)]
    look: LookArgs,

    #[command(flatten)]
    skip: SkipArgs,

    #[command(flatten)]
    volume: VolumeArgs,
}

/// What was made and how long it took.
struct Made {
    frames_ms: Vec<f64>,
    samples: u64,
    map_reads: u64,
    /// Samples and map reads of a white pixel, where those are shown.
    white: Option<u32>,
    leaping: Leaping,
    gradient_map: Option<GradientMapSize>,
    /// How one cast has made the last pair, and the bytes that it has taken besides both pictures.
    pairing: Option<Pairing>,
    pair_bytes: Option<u64>,
    picture_size: [u32; 2],
    outputs: Vec<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    check_writable(&args.output, args.camera.stereo.extension())?;
    let frames = args.frames();
    let outputs = (0..frames).filter_map(|index| args.path_of(index, frames));
    check_apart(outputs, [args.volume.file.as_path()].into_iter().chain(args.look.file()))?;
    args.camera.check()?;
    args.look.check()?;
    args.check_detail()?;
    let request = args.pair_request()?;
    let skipping = args.skip.resolve(SkipName::Auto)?;
    let mut loaded = args.volume.load()?;
    let look = args.look.resolve(&loaded.volume)?;
    if args.level_of_detail.is_some() && look.settings.transfer.is_2d() {
        return Err(Failure::input("--level-of-detail needs a transfer function of one dimension"));
    }
    loaded.volume.fill_non_finite(look.settings.window.lo());
    let volume = &loaded.volume;
    let placement = args.camera.aim.placement(volume);
    let parameters = CastParameters::new(&look.settings, &placement);
    let coarser = args.level_of_detail.map_or_else(Vec::new, |_| volume.coarser_levels());
    let needs_gpu = request.is_some_and(|request| request.is_single_pass());
    let (engine, made) = make_on(
        args.backend,
        |choice| args.open(choice, volume, needs_gpu),
        |engine| args.make(engine, &coarser, &parameters, &skipping, request),
    )?;
    args.report(&loaded, &look, &engine, &made)
}

impl RenderArgs {
    /// How the pair is to be made, if there is one.
    fn pair_request(&self) -> Result<Option<PairRequest>, Failure> {
        let is_wobble = self.camera.stereo == Stereo::Wobble;
        if is_wobble && self.bits != Bits::Eight {
            return Err(Failure::input("--bits 16 needs a PNG file: --stereo wobble writes a GIF file"));
        }
        let request = self.pair.resolve(self.camera.stereo)?;
        let is_single_pass = request.is_some_and(|request| request.is_single_pass());
        let refusal = match (self.show, self.level_of_detail) {
            (Show::Picture, None) => return Ok(request),
            (Show::Samples(_), _) => "--show samples needs a cast of each eye: --stereo-method two-pass",
            (Show::Picture, Some(_)) => {
                "--level-of-detail needs a cast of each eye: --stereo-method two-pass"
            }
        };
        if is_single_pass { Err(Failure::input(refusal)) } else { Ok(None) }
    }

    fn check_detail(&self) -> Result<(), Failure> {
        let mode = self.look.mode_name();
        if self.level_of_detail.is_some() && mode != ModeName::Dvr {
            return Err(Failure::input(format!(
                "--level-of-detail needs --mode dvr, not --mode {}",
                mode.name()
            )));
        }
        Ok(())
    }

    fn open<'v>(
        &self,
        choice: BackendChoice,
        volume: &'v Volume,
        needs_gpu: bool,
    ) -> Result<Engine<'v>, Failure> {
        let longest = volume.grid().dims().into_iter().max().unwrap_or(1);
        let job = Job {
            rays: self.rays() * u64::from(self.frames() + u32::from(self.warms_up())),
            samples_per_ray: longest as f64 * self.look.sampling_factor,
            needs_gpu,
        };
        Engine::open(choice, &job, volume, self.look.storage.kind(volume))
    }

    /// Frames that are cast.
    fn frames(&self) -> u32 {
        self.turntable.or(self.frames).unwrap_or(1)
    }

    /// Pixels of one frame.
    fn rays(&self) -> u64 {
        let views = if self.camera.stereo.has_both_eyes() { 2 } else { 1 };
        self.camera.size.iter().map(|&side| u64::from(side)).product::<u64>() * views
    }

    /// Whether a frame that is not timed comes first: where times are asked for.
    fn warms_up(&self) -> bool {
        self.json || self.frames.is_some() || self.turntable.is_some()
    }

    fn make<'v>(
        &self,
        engine: &mut Engine<'v>,
        coarser: &'v [Volume],
        parameters: &CastParameters,
        skipping: &Skipping,
        request: Option<PairRequest>,
    ) -> Result<Made, Failure> {
        engine.add_levels(coarser)?;
        let frames = self.frames();
        let bar = Bar::new("frames", u64::from(frames));
        let shot = match self.level_of_detail {
            None => engine.prepare(parameters, skipping)?,
            Some(pixels) => engine.prepare_detail(parameters, skipping, LevelOfDetail::Pixels(pixels))?,
        };
        let views = self.camera.views(0.0)?;
        let mut made = Made {
            frames_ms: Vec::new(),
            samples: 0,
            map_reads: 0,
            white: self.white_of_all(engine, shot)?,
            leaping: engine.leaping(shot).clone(),
            gradient_map: engine.gradient_map_size(shot),
            pairing: request.and_then(|request| request.pairing(engine, parameters, &views)),
            pair_bytes: None,
            picture_size: [0; 2],
            outputs: Vec::new(),
        };
        if self.warms_up() {
            self.cast(engine, shot, 0.0, &mut made)?;
        }
        for index in 0..frames {
            let turn_deg = self.turntable.map_or(0.0, |frames| turn_deg(index, frames));
            let frame_ms = self.cast(engine, shot, turn_deg, &mut made)?;
            made.frames_ms.push(frame_ms);
            if let Some(path) = self.path_of(index, frames) {
                let casts = engine.read()?;
                let picture = match self.show {
                    Show::Picture => self.arrange(casts.iter().map(|cast| &cast.image)),
                    Show::Samples(_) => {
                        let white = *made.white.get_or_insert_with(|| most_reads(&casts));
                        let maps: Vec<Image> = casts.iter().map(|cast| heat_map(cast, white)).collect();
                        self.arrange(&maps)
                    }
                };
                picture.write(&path, self.bits)?;
                made.samples = casts.iter().map(|cast| cast.samples).sum();
                made.map_reads = casts.iter().map(|cast| cast.map_reads).sum();
                made.picture_size = picture.size();
                made.outputs.push(path);
            }
            bar.advance();
        }
        Ok(made)
    }

    /// Casts one frame and returns its time, ms. Where one cast cannot make the pair, two do from then on.
    fn cast(
        &self,
        engine: &mut Engine<'_>,
        shot: Shot,
        turn_deg: f64,
        made: &mut Made,
    ) -> Result<f64, Failure> {
        let views = self.camera.views(turn_deg)?;
        if let (Some(pairing), &[left, right]) = (made.pairing, &views[..]) {
            match engine.cast_pair(shot, [left, right], &pairing) {
                Ok(pair) => {
                    made.pair_bytes = Some(pair.report.bytes);
                    return Ok(milliseconds(pair.time));
                }
                Err(Underived::Gpu(error)) => return Err(error.into()),
                Err(Underived::Refused(why)) => {
                    eprintln!("note: {} cannot make this pair ({why}): using two-pass", pairing.form.name());
                    (made.pairing, made.pair_bytes) = (None, None);
                }
            }
        }
        Ok(milliseconds(engine.cast(shot, &views)?))
    }

    /// Samples and map reads of a white pixel in all pictures: those asked for, or the most of any ray of a turntable.
    fn white_of_all(&self, engine: &mut Engine<'_>, shot: Shot) -> Result<Option<u32>, Failure> {
        match (self.show, self.turntable) {
            (Show::Samples(Some(white)), _) => Ok(Some(white.get())),
            (Show::Samples(None), Some(frames)) => {
                let mut most = 0;
                for index in 0..frames {
                    engine.cast(shot, &self.camera.views(turn_deg(index, frames))?)?;
                    most = most.max(most_reads(&engine.read()?));
                }
                Ok(Some(most))
            }
            (Show::Samples(None) | Show::Picture, _) => Ok(None),
        }
    }

    fn arrange<'i>(&self, images: impl IntoIterator<Item = &'i Image>) -> Picture {
        self.camera.arrange(&images.into_iter().collect::<Vec<_>>(), self.background)
    }

    /// Where frame `index` of `frames` is written, if it is: each of a turntable, the last of repeated ones.
    fn path_of(&self, index: u32, frames: u32) -> Option<PathBuf> {
        match self.turntable {
            Some(_) => Some(numbered(&self.output, index)),
            None => (index + 1 == frames).then(|| self.output.clone()),
        }
    }

    /// Name of what has made both eyes' pictures.
    fn stereo_method(&self, made: &Made) -> Option<&'static str> {
        let of_both = self.camera.stereo.has_both_eyes();
        of_both.then(|| made.pairing.map_or("two-pass", |pairing| pairing.form.name()))
    }

    fn report(&self, loaded: &Loaded, look: &Look, engine: &Engine<'_>, made: &Made) -> Result<(), Failure> {
        let dims = loaded.volume.grid().dims();
        let frame_ms = median(&made.frames_ms);
        let settings = &look.settings;
        if self.json {
            let outputs: Vec<String> = made.outputs.iter().map(|path| path.display().to_string()).collect();
            let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
            return print_json(&json!({
                "backend": engine.backend_name(),
                "device": engine.device_name(),
                "driver": engine.driver_name(),
                "dims": dims,
                "size": self.camera.size,
                "picture_size": made.picture_size,
                "mode": look.mode.name(),
                "shading": spec::shading_name(settings.shading),
                "tf": look.transfer_name,
                "window": [settings.window.lo(), settings.window.hi()],
                "frame_ms": frame_ms,
                "frames_ms": made.frames_ms,
                "samples": made.samples,
                "rays": self.rays(),
                "stereo_method": self.stereo_method(made),
                "stereo_quality": made.pairing.map(|pairing| pairing.quality.name()),
                "reference_eye": made.pairing.map(|pairing| pairing.reference.name()),
                "stereo_bytes": made.pair_bytes,
                "skip": made.leaping.to_json(made.map_reads),
                "gradient_map": made.gradient_map.map(GradientMapSize::to_json),
                "white": made.white,
                "level_of_detail": self.level_of_detail,
                "upload_ms": milliseconds(engine.upload_time()),
                "outputs": outputs,
                "warnings": warnings,
            }));
        }
        let stereo = match (&made.pairing, self.stereo_method(made)) {
            (Some(pairing), Some(method)) => format!(" by {method} ({})", pairing.quality.name()),
            (None, Some(method)) => format!(" by {method}"),
            (_, None) => String::new(),
        };
        eprintln!(
            "{}×{}×{} → {}x{} {}{stereo} on {} ({}): {frame_ms:.1} ms, {:.1} M samples, {} → {}",
            dims[0],
            dims[1],
            dims[2],
            made.picture_size[0],
            made.picture_size[1],
            look.mode.name(),
            engine.backend_name(),
            engine.device_name(),
            made.samples as f64 / 1e6,
            made.leaping.described(made.map_reads),
            described(&made.outputs),
        );
        if let Some(white) = made.white {
            eprintln!("white is {white} samples and map reads");
        }
        Ok(())
    }
}
