//! `render`: a volume file to a picture.

use crate::backend::{
    BackendChoice, Engine, GradientMapSize, Job, Leaping, Shot, median, milliseconds, note_fallback,
};
use crate::camera::{CameraArgs, Stereo};
use crate::failure::Failure;
use crate::heat_map::{heat_map, most_reads};
use crate::look::{Look, LookArgs};
use crate::output::{check_writable, numbered, print_json};
use crate::picture::{Bits, write_png};
use crate::progress::Bar;
use crate::skipping::{SkipArgs, SkipName, Skipping};
use crate::spec::{self, Show};
use crate::volume_args::VolumeArgs;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::{Image, RgbImage};
use wheatstone_core::scene::Placement;
use wheatstone_core::view::world_from_patient;
use wheatstone_core::volume::Volume;
use wheatstone_io::Loaded;

/// Render a volume to a PNG picture, for one eye or two.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone render head.nii.gz -o head.png\n  \
    wheatstone render head.nii.gz -o head.png --tf mri-brain-t1 --shading phong --azimuth 30\n  \
    wheatstone render ct.nrrd -o ct.png --tf ct-bone --stereo side-by-side --size 1024x1024\n  \
    wheatstone render ct.nrrd -o mip.png --mode mip --window -100..400 --up A\n  \
    wheatstone render bonsai_256x256x256_uint8.raw -o b.png --tf ramp:0.15..1 --ert 0 --json\n  \
    wheatstone render scan.raw --raw-size 64x64x32 --raw-type int16 -o scan.png --iso 0.4\n  \
    wheatstone render head.nii.gz -o turn.png --turntable 36\n  \
    wheatstone render head.nii.gz -o reads.png --ert 0 --skip distance --block-size 4 --show samples\n\n\
    --tf, --iso, V and G are normalised: 0 and 1 are the ends of the window. docs/cli.md tells which window counts.")]
pub(crate) struct RenderArgs {
    /// The PNG file to write.
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

    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    camera: CameraArgs,

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
    picture_size: [u32; 2],
    outputs: Vec<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    check_writable(&args.output, "png")?;
    args.camera.check()?;
    args.look.check()?;
    let skipping = args.skip.resolve(SkipName::Auto)?;
    let mut loaded = args.volume.load()?;
    let look = args.look.resolve(&loaded.volume)?;
    loaded.volume.fill_non_finite(look.settings.window.lo());
    let volume = &loaded.volume;
    let placement = Placement::new(volume, world_from_patient(volume.grid(), args.camera.up.direction()));
    let parameters = CastParameters::new(&look.settings, &placement);
    let mut engine = args.open(args.backend, volume)?;
    let made = match args.make(&mut engine, &parameters, &skipping) {
        Err(Failure::Gpu(error)) if args.backend == BackendChoice::Auto => {
            note_fallback(&error);
            engine = args.open(BackendChoice::Cpu, volume)?;
            args.make(&mut engine, &parameters, &skipping)?
        }
        made => made?,
    };
    args.report(&loaded, &look, &engine, &made)
}

impl RenderArgs {
    fn open<'v>(&self, choice: BackendChoice, volume: &'v Volume) -> Result<Engine<'v>, Failure> {
        let frames = self.turntable.or(self.frames).unwrap_or(1);
        let longest = volume.grid().dims().into_iter().max().unwrap_or(1);
        let job = Job {
            rays: self.rays() * u64::from(frames + u32::from(self.warms_up())),
            samples_per_ray: longest as f64 * self.look.sampling_factor,
        };
        Engine::open(choice, &job, volume, self.look.storage.kind(volume))
    }

    /// Rays of one frame.
    fn rays(&self) -> u64 {
        let views = match self.camera.stereo {
            Stereo::None | Stereo::Left | Stereo::Right => 1,
            Stereo::SideBySide | Stereo::TopBottom | Stereo::Anaglyph => 2,
        };
        self.camera.size.iter().map(|&side| u64::from(side)).product::<u64>() * views
    }

    /// Whether a frame that is not timed comes first: where times are asked for.
    fn warms_up(&self) -> bool {
        self.json || self.frames.is_some() || self.turntable.is_some()
    }

    fn make(
        &self,
        engine: &mut Engine<'_>,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Made, Failure> {
        let frames = self.turntable.or(self.frames).unwrap_or(1);
        let bar = Bar::new("frames", u64::from(frames));
        let shot = engine.prepare(parameters, skipping)?;
        let mut made = Made {
            frames_ms: Vec::new(),
            samples: 0,
            map_reads: 0,
            white: self.white_of_all(engine, shot)?,
            leaping: engine.leaping(shot).clone(),
            gradient_map: engine.gradient_map_size(shot),
            picture_size: [0; 2],
            outputs: Vec::new(),
        };
        if self.warms_up() {
            engine.cast(shot, &self.camera.views(0.0)?)?;
        }
        for index in 0..frames {
            let turn_deg = self.turntable.map_or(0.0, |frames| turn_deg(index, frames));
            made.frames_ms.push(milliseconds(engine.cast(shot, &self.camera.views(turn_deg)?)?));
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
                write_png(&path, &picture, self.bits)?;
                made.samples = casts.iter().map(|cast| cast.samples).sum();
                made.map_reads = casts.iter().map(|cast| cast.map_reads).sum();
                made.picture_size = [picture.width, picture.height];
                made.outputs.push(path);
            }
            bar.advance();
        }
        Ok(made)
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

    fn arrange<'i>(&self, images: impl IntoIterator<Item = &'i Image>) -> RgbImage {
        self.camera.arrange(&images.into_iter().collect::<Vec<_>>(), self.background)
    }

    /// Where frame `index` of `frames` is written, if it is: each of a turntable, the last of repeated ones.
    fn path_of(&self, index: u32, frames: u32) -> Option<PathBuf> {
        match self.turntable {
            Some(_) => Some(numbered(&self.output, index)),
            None => (index + 1 == frames).then(|| self.output.clone()),
        }
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
                "skip": made.leaping.to_json(made.map_reads),
                "gradient_map": made.gradient_map.map(GradientMapSize::to_json),
                "white": made.white,
                "upload_ms": milliseconds(engine.upload_time()),
                "outputs": outputs,
                "warnings": warnings,
            }));
        }
        eprintln!(
            "{}×{}×{} → {}x{} {} on {} ({}): {frame_ms:.1} ms, {:.1} M samples, {} → {}",
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

/// How far the eye has turned in a picture of a turntable.
fn turn_deg(index: u32, frames: u32) -> f64 {
    360.0 / f64::from(frames) * f64::from(index)
}

fn described(outputs: &[PathBuf]) -> String {
    match outputs {
        [] => "nothing".to_owned(),
        [one] => one.display().to_string(),
        [first, .., last] => format!("{} … {}", first.display(), last.display()),
    }
}
