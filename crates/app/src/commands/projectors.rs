//! `projectors`: a volume to the frames of a display of projectors.

use crate::backend::{BackendChoice, Engine, Job, Leaping, ResolvedShot, make_on, median, milliseconds};
use crate::camera::AimArgs;
use crate::display::ArrayArgs;
use crate::failure::Failure;
use crate::look::{Look, LookArgs, ModeName};
use crate::output::{check_apart, check_writable, described, numbered, print_json};
use crate::picture::{Bits, write_png};
use crate::progress::Bar;
use crate::skipping::{SkipArgs, SkipName, Skipping};
use crate::spec;
use crate::stand::{Stand, StandArgs};
use crate::text_file::read_text_file;
use crate::volume_args::VolumeArgs;
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::{Path, PathBuf};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::calibration::Corrections;
use wheatstone_core::lightfield::{Coarseness, ProjectorArray};
use wheatstone_core::volume::Volume;
use wheatstone_io::Loaded;

/// Render a volume to the frames of a light-field display of projectors.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone projectors ct.nrrd -o frame.png --tf ct-bone --shading phong\n  \
    wheatstone projectors angio.nii.gz -o frame.png --display mine.json --mode mip --volume-size 0.2\n  \
    wheatstone projectors ct.nrrd -o frame.png --display mine.json --corrections corrections.json\n  \
    wheatstone simulate frame_*.png -o seen.png --display agus-2008 --eye 0.1,0,1\n\n\
    Frames are numbered from 0000. Each holds the images of several projectors below a header with their ids.")]
pub(crate) struct ProjectorsArgs {
    /// The PNG files to write, numbered from 0000 before the extension.
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,

    #[command(flatten)]
    stand: StandArgs,

    /// Whether what the display cannot resolve is cast of coarser voxels by longer steps, or all in full
    /// [default: matched where it can be: dvr, one-dimensional functions].
    #[arg(long, value_enum)]
    resolution: Option<ResolutionName>,

    /// Warps and colour tables that the projectors' images go through.
    #[arg(long, value_name = "CORRECTIONS.json")]
    corrections: Option<PathBuf>,

    /// Colour behind the volume.
    #[arg(long, value_name = "RRGGBB", default_value = "000000", value_parser = spec::color)]
    background: [f32; 3],

    /// Bits per channel of the PNG files.
    #[arg(long, value_enum, default_value = "8")]
    bits: Bits,

    /// What casts the rays.
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,

    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    display: ArrayArgs,

    #[command(flatten)]
    aim: AimArgs,

    #[command(flatten)]
    look: LookArgs,

    #[command(flatten)]
    skip: SkipArgs,

    #[command(flatten)]
    volume: VolumeArgs,
}

/// How finely volumes are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ResolutionName {
    /// As finely as the display resolves at each depth.
    Matched,
    /// Voxel by voxel.
    Full,
}

impl ResolutionName {
    fn name(self) -> &'static str {
        match self {
            Self::Matched => "matched",
            Self::Full => "full",
        }
    }
}

/// A display, how the volume stands in it, and how finely it is cast.
struct Stage {
    array: ProjectorArray,
    stand: Stand,
    resolution: ResolutionName,
    corrections: Option<Corrections>,
}

/// What was made and how long it took.
struct Made {
    projectors_ms: Vec<f64>,
    /// Over those at full detail.
    coarseness: Coarseness,
    samples: u64,
    map_reads: u64,
    leaping: Leaping,
    outputs: Vec<PathBuf>,
}

/// Most bytes of a file of corrections: a warp of 40 × 30 nodes takes 40 kB.
const MOST_BYTES: u64 = 1 << 26;

/// Runs the command.
pub(crate) fn run(args: &ProjectorsArgs) -> Result<(), Failure> {
    check_writable(&args.output, "png")?;
    args.look.check()?;
    let skipping = args.skip.resolve(SkipName::Auto)?;
    let array = args.display.resolve()?;
    args.check_apart(&array)?;
    let corrections = args.corrections.as_deref().map(|path| read_corrections(path, &array)).transpose()?;
    let mut loaded = args.volume.load()?;
    let look = args.look.resolve(&loaded.volume)?;
    let resolution = args.resolution(&look)?;
    loaded.volume.fill_non_finite(look.settings.window.lo());
    let volume = &loaded.volume;
    let parameters = CastParameters::new(&look.settings, &args.aim.placement(volume));
    let viewer = ("viewer", array.virtual_viewer_m().z);
    let corners = parameters.visible_corners_world();
    let stand = args.stand.resolve(&args.aim, corners, viewer, |points, before_m| {
        array.largest_scale(points.iter().copied(), before_m)
    })?;
    let stage = Stage { array, stand, resolution, corrections };
    stage.warn_of_cuts();
    let coarser = match resolution {
        ResolutionName::Matched => volume.coarser_levels(),
        ResolutionName::Full => Vec::new(),
    };
    let (engine, made) = make_on(
        args.backend,
        |choice| args.open(choice, &stage, volume),
        |engine| args.make(engine, &stage, &coarser, &parameters, &skipping),
    )?;
    args.report(&stage, &loaded, &look, &engine, &made)
}

fn read_corrections(path: &Path, array: &ProjectorArray) -> Result<Corrections, Failure> {
    read_text_file(path, MOST_BYTES, "corrections", |text| Corrections::from_json(text, array))
}

impl ProjectorsArgs {
    fn check_apart(&self, array: &ProjectorArray) -> Result<(), Failure> {
        let frames = array.batches().len() as u32;
        let outputs = (0..self.stand.pictures()).flat_map(|turn| (0..frames).map(move |frame| (turn, frame)));
        let outputs = outputs.map(|(turn, frame)| self.path(turn, frame));
        let flags = [self.look.file(), self.display.file(), self.corrections.as_deref()];
        check_apart(outputs, [self.volume.file.as_path()].into_iter().chain(flags.into_iter().flatten()))
    }

    /// A frame of a picture of the turntable, if there is one.
    fn path(&self, turn: u32, frame: u32) -> PathBuf {
        if self.stand.is_turning() {
            numbered(&numbered(&self.output, turn), frame)
        } else {
            numbered(&self.output, frame)
        }
    }

    fn resolution(&self, look: &Look) -> Result<ResolutionName, Failure> {
        let can_be_matched = look.mode == ModeName::Dvr && !look.settings.transfer.is_2d();
        match self.resolution {
            None if can_be_matched => Ok(ResolutionName::Matched),
            None => Ok(ResolutionName::Full),
            Some(ResolutionName::Matched) if !can_be_matched => Err(Failure::input(
                "--resolution matched needs --mode dvr and a transfer function of one dimension",
            )),
            Some(resolution) => Ok(resolution),
        }
    }

    fn open<'v>(
        &self,
        choice: BackendChoice,
        stage: &Stage,
        volume: &'v Volume,
    ) -> Result<Engine<'v>, Failure> {
        let longest = volume.grid().dims().into_iter().max().unwrap_or(1);
        let job = Job {
            rays: stage.rays() * u64::from(stage.stand.pictures()),
            samples_per_ray: longest as f64 * self.look.sampling_factor,
            needs_gpu: false,
        };
        Engine::open(choice, &job, volume, self.look.storage.kind(volume))
    }

    fn make<'v>(
        &self,
        engine: &mut Engine<'v>,
        stage: &Stage,
        coarser: &'v [Volume],
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Made, Failure> {
        engine.add_levels(coarser)?;
        let ResolvedShot { shot, coarseness } = match stage.resolution {
            ResolutionName::Full => ResolvedShot::in_full(engine.prepare(parameters, skipping)?),
            ResolutionName::Matched => {
                let displays_from_world: Vec<_> = stage.stand.displays_from_world().collect();
                engine.prepare_resolved(parameters, skipping, &stage.array, &displays_from_world)?
            }
        };
        let mut made = Made {
            projectors_ms: Vec::new(),
            coarseness,
            samples: 0,
            map_reads: 0,
            leaping: engine.leaping(shot).clone(),
            outputs: Vec::new(),
        };
        let projectors = stage.array.projectors().len() as u64;
        let bar = Bar::new("images", u64::from(stage.stand.pictures()) * projectors);
        for (turn, display_from_world) in (0..).zip(stage.stand.displays_from_world()) {
            (made.samples, made.map_reads) = (0, 0);
            let views = stage.array.views(display_from_world);
            for (index, batch) in (0..).zip(stage.array.batches()) {
                let images = batch
                    .clone()
                    .map(|projector| {
                        bar.advance();
                        made.projectors_ms.push(milliseconds(engine.cast(shot, &[views[projector]])?));
                        self.image(engine, stage, projector, &mut made)
                    })
                    .collect::<Result<Vec<_>, _>>()?;
                let frame = stage.array.pack_batch(batch, &images).map_err(Failure::input)?;
                let path = self.path(turn, index);
                write_png(&path, &frame, self.bits)?;
                made.outputs.push(path);
            }
        }
        Ok(made)
    }

    /// What a projector is sent of the picture that was cast last.
    fn image(
        &self,
        engine: &mut Engine<'_>,
        stage: &Stage,
        projector: usize,
        made: &mut Made,
    ) -> Result<RgbImage, Failure> {
        let cast = engine.read()?.swap_remove(0);
        made.samples += cast.samples;
        made.map_reads += cast.map_reads;
        let ideal = cast.image.over_background(self.background);
        let id = stage.array.projectors()[projector].id;
        Ok(match &stage.corrections {
            Some(corrections) => corrections.apply(id, ideal),
            None => ideal,
        })
    }

    fn report(
        &self,
        stage: &Stage,
        loaded: &Loaded,
        look: &Look,
        engine: &Engine<'_>,
        made: &Made,
    ) -> Result<(), Failure> {
        let Stage { array, stand, .. } = stage;
        let description = array.description();
        let dims = loaded.volume.grid().dims();
        let picture_ms = made.projectors_ms.iter().sum::<f64>() / f64::from(stand.pictures());
        let settings = &look.settings;
        if self.json {
            let resolved_m = |from_screen_m: f64| array.resolution().size_m(from_screen_m);
            let outputs: Vec<String> = made.outputs.iter().map(|path| path.display().to_string()).collect();
            let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
            return print_json(&json!({
                "backend": engine.backend_name(),
                "device": engine.device_name(),
                "driver": engine.driver_name(),
                "dims": dims,
                "projectors": array.projectors().len(),
                "image_size": description.image_size_px,
                "frame_size": description.packing.frame_size_px,
                "frames": array.batches().len(),
                "resolution": stage.resolution.name(),
                "longest_step": made.coarseness.step_ratio(),
                "voxels_per_step": made.coarseness.voxels_per_step(),
                "volume_size_m": stand.volume_size_m,
                "behind_screen_m": -stand.reach_m.start,
                "before_screen_m": stand.reach_m.end,
                "resolved_m": {
                    "screen": resolved_m(0.0),
                    "behind": resolved_m(stand.reach_m.start.min(0.0)),
                    "before": resolved_m(stand.reach_m.end.max(0.0)),
                },
                "mode": look.mode.name(),
                "shading": spec::shading_name(settings.shading),
                "tf": look.transfer_name,
                "window": [settings.window.lo(), settings.window.hi()],
                "projector_ms": median(&made.projectors_ms),
                "picture_ms": picture_ms,
                "samples": made.samples,
                "rays": stage.rays(),
                "skip": made.leaping.to_json(made.map_reads),
                "upload_ms": milliseconds(engine.upload_time()),
                "outputs": outputs,
                "warnings": warnings,
            }));
        }
        eprintln!(
            "{}×{}×{} → {} images of {}x{} {} on {} ({}): {picture_ms:.0} ms, {:.1} M samples at {} resolution, {} → {}",
            dims[0],
            dims[1],
            dims[2],
            array.projectors().len(),
            description.image_size_px[0],
            description.image_size_px[1],
            look.mode.name(),
            engine.backend_name(),
            engine.device_name(),
            made.samples as f64 / 1e6,
            stage.resolution.name(),
            made.leaping.described(made.map_reads),
            described(&made.outputs),
        );
        Ok(())
    }
}

impl Stage {
    /// Pixels of all projectors.
    fn rays(&self) -> u64 {
        let [width, height] = self.array.description().image_size_px.map(u64::from);
        width * height * self.array.projectors().len() as u64
    }

    /// Tells of what is where no beams can show it.
    fn warn_of_cuts(&self) {
        let viewer_m = self.array.virtual_viewer_m().z;
        let emitter_m =
            self.array.projectors().iter().map(|p| p.emitter().z).fold(f64::NEG_INFINITY, f64::max);
        let reach_m = &self.stand.reach_m;
        if reach_m.end > viewer_m || reach_m.start < emitter_m {
            eprintln!(
                "warning: the volume reaches {}: what is beyond the emitters, {:.3} m behind it, or the viewer, {viewer_m:.3} m before it, \
                 is cut off",
                self.stand.reach(|metres| format!("{metres:.3} m")),
                -emitter_m,
            );
        }
    }
}
