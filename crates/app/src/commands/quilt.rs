//! `quilt`: a volume to the views of a display behind lenses.

use crate::backend::{
    AnchorCast, BackendChoice, Engine, Job, Leaping, Shot, Underived, make_on, median, milliseconds,
};
use crate::camera::AimArgs;
use crate::display::{Display, DisplayArgs, read_calibration};
use crate::failure::Failure;
use crate::look::{Look, LookArgs};
use crate::many_views::{AnchorRequest, ViewsArgs};
use crate::output::{check_apart, check_writable, described, print_json};
use crate::picture::{Bits, write_png, write_png_with_exif};
use crate::progress::Bar;
use crate::quilt_file::{QuiltPaths, metadata};
use crate::skipping::{SkipArgs, SkipName, Skipping};
use crate::spec;
use crate::stand::{Stand, StandArgs};
use crate::volume_args::VolumeArgs;
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::PathBuf;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::quilt::Sampling;
use wheatstone_core::lightfield::{Lenticular, QuiltDisplay};
use wheatstone_core::view::View;
use wheatstone_core::volume::Volume;
use wheatstone_io::Loaded;

/// Render a volume to a quilt: the views of a display behind lenses, in one PNG picture.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone quilt head.nii.gz -o head.png --tf mri-brain-t1 --shading phong\n  \
    wheatstone quilt ct.nrrd -o ct_qs11x6a0.5625.png --display go --tf ct-bone --volume-size 0.05\n  \
    wheatstone quilt ct.nrrd -o ct.png --display mine.json --interlace visual.json\n  \
    wheatstone quilt ct.nrrd -o ct.png --columns 4 --rows 4 --quilt-size 2048x2048 --aspect 1.6 --view-cone 35\n  \
    wheatstone quilt head.nii.gz -o turn.png --turntable 36\n\n\
    _qs{columns}x{rows}a{aspect} is added to the name. View 0 is the bottom left tile and that of the leftmost camera.")]
pub(crate) struct QuiltArgs {
    /// The PNG file to write.
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,

    /// Where in the view cone the cameras are: camera i of N at (i + 1/2)/N, or at i/(N - 1).
    #[arg(long, value_enum, default_value_t = SamplingName::Middles)]
    sampling: SamplingName,

    #[command(flatten)]
    stand: StandArgs,

    /// Pixels of a view by which things may move from one view to the next before a warning tells of ghosts.
    #[arg(long, value_name = "PIXELS", default_value = "2", value_parser = spec::within(0.1..=1000.0), allow_negative_numbers = true)]
    most_disparity: f64,

    /// Write the picture for the panel as well, beside the quilt, by the display's calibration (visual.json).
    #[arg(long, value_name = "CALIBRATION.json")]
    interlace: Option<PathBuf>,

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
    views: ViewsArgs,

    #[command(flatten)]
    display: DisplayArgs,

    #[command(flatten)]
    aim: AimArgs,

    #[command(flatten)]
    look: LookArgs,

    #[command(flatten)]
    skip: SkipArgs,

    #[command(flatten)]
    volume: VolumeArgs,
}

/// Where in the view cone cameras are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SamplingName {
    /// In the middle of the directions in which their views are seen.
    Middles,
    /// From one end to the other.
    Ends,
}

impl SamplingName {
    fn sampling(self) -> Sampling {
        match self {
            Self::Middles => Sampling::Middles,
            Self::Ends => Sampling::Ends,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Middles => "middles",
            Self::Ends => "ends",
        }
    }
}

/// A display, how the volume stands in it, and how its views are made.
struct Stage {
    display: QuiltDisplay,
    lenses: Option<Lenticular>,
    paths: QuiltPaths,
    stand: Stand,
    /// What views are derived from; nothing where each is cast.
    anchors: Option<AnchorRequest>,
}

/// What was made and how long it took.
struct Made {
    /// Of every view, without the anchors.
    views_ms: Vec<f64>,
    /// Of the anchors of all quilts.
    anchors_ms: f64,
    /// Those of the last quilt.
    anchors: Option<AnchorCast>,
    samples: u64,
    map_reads: u64,
    leaping: Leaping,
    outputs: Vec<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(args: &QuiltArgs) -> Result<(), Failure> {
    check_writable(&args.output, "png")?;
    args.look.check()?;
    let skipping = args.skip.resolve(SkipName::Auto)?;
    let anchors = args.views.resolve()?;
    let lenses = args.interlace.as_deref().map(read_calibration).transpose()?;
    let Display::Lenses(display) = args.display.resolve(lenses.as_ref())? else {
        return Err(Failure::input("quilts are for displays behind lenses: this one has projectors"));
    };
    let paths = QuiltPaths::new(&args.output, &display)?;
    check_writable(&paths.quilt(args.stand.is_turning().then_some(0)), "png")?;
    args.check_apart(&paths)?;
    let mut loaded = args.volume.load()?;
    let look = args.look.resolve(&loaded.volume)?;
    loaded.volume.fill_non_finite(look.settings.window.lo());
    let volume = &loaded.volume;
    let parameters = CastParameters::new(&look.settings, &args.aim.placement(volume));
    let corners = parameters.visible_corners_world();
    let cameras = ("cameras", display.focal_distance_m);
    let stand = args.stand.resolve(&args.aim, corners, cameras, |points, before_m| {
        display.largest_scale(points.iter().copied(), before_m)
    })?;
    let stage = Stage { display, lenses, paths, stand, anchors };
    args.warn_of_ghosts(&stage);
    let (engine, made) = make_on(
        args.backend,
        |choice| args.open(choice, &stage, volume),
        |engine| args.make(engine, &stage, &parameters, &skipping),
    )?;
    args.report(&stage, &loaded, &look, &engine, &made)
}

impl QuiltArgs {
    fn check_apart(&self, paths: &QuiltPaths) -> Result<(), Failure> {
        let numbers = (0..self.stand.pictures()).map(|turn| self.stand.is_turning().then_some(turn));
        let interlaced = |number| self.interlace.is_some().then(|| paths.interlaced(number));
        let outputs = numbers.flat_map(|number| [Some(paths.quilt(number)), interlaced(number)]).flatten();
        let flags = [self.look.file(), self.display.file(), self.interlace.as_deref()];
        check_apart(outputs, [self.volume.file.as_path()].into_iter().chain(flags.into_iter().flatten()))
    }

    fn warn_of_ghosts(&self, stage: &Stage) {
        let limits = stage.display.depth_range(self.sampling.sampling(), self.most_disparity);
        let [behind_m, before_m] = [-stage.stand.reach_m.start, stage.stand.reach_m.end];
        if before_m <= limits.before_m && behind_m <= limits.behind_m {
            return;
        }
        let written = |metres: f64| format!("{:.1} mm", metres * 1e3);
        eprintln!(
            "warning: the volume reaches {}; beyond {} behind and {} before things move by more than {} pixels \
             from view to view, which is seen as ghosts: --volume-size makes it smaller",
            stage.stand.reach(written),
            written(limits.behind_m),
            written(limits.before_m),
            self.most_disparity,
        );
    }

    fn open<'v>(
        &self,
        choice: BackendChoice,
        stage: &Stage,
        volume: &'v Volume,
    ) -> Result<Engine<'v>, Failure> {
        let longest = volume.grid().dims().into_iter().max().unwrap_or(1);
        let job = Job {
            rays: rays(&stage.display) * u64::from(stage.stand.pictures()),
            samples_per_ray: longest as f64 * self.look.sampling_factor,
            needs_gpu: stage.anchors.is_some(),
        };
        Engine::open(choice, &job, volume, self.look.storage.kind(volume))
    }

    fn make(
        &self,
        engine: &mut Engine<'_>,
        stage: &Stage,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Made, Failure> {
        let shot = engine.prepare(parameters, skipping)?;
        let mut made = Made {
            views_ms: Vec::new(),
            anchors_ms: 0.0,
            anchors: None,
            samples: 0,
            map_reads: 0,
            leaping: engine.leaping(shot).clone(),
            outputs: Vec::new(),
        };
        let exif = metadata(&stage.display)?;
        let bar = Bar::new("views", u64::from(stage.stand.pictures() * stage.display.view_count()));
        for (turn, display_from_world) in (0..).zip(stage.stand.displays_from_world()) {
            let views = stage.display.views(self.sampling.sampling(), display_from_world);
            let quilt = self.cast(engine, shot, stage, &views, &mut made, &bar)?;
            let number = stage.stand.is_turning().then_some(turn);
            let path = stage.paths.quilt(number);
            write_png_with_exif(&path, &quilt, self.bits, exif.clone())?;
            made.outputs.push(path);
            if let Some(lenses) = &stage.lenses {
                let interlaced = lenses.interlace(&stage.display, &quilt).map_err(Failure::input)?;
                let path = stage.paths.interlaced(number);
                write_png(&path, &interlaced, self.bits)?;
                made.outputs.push(path);
            }
        }
        Ok(made)
    }

    /// The quilt of some views, view by view.
    fn cast(
        &self,
        engine: &mut Engine<'_>,
        shot: Shot,
        stage: &Stage,
        views: &[View],
        made: &mut Made,
        bar: &Bar,
    ) -> Result<RgbImage, Failure> {
        let display = &stage.display;
        let [width, height] = display.quilt_size_px;
        let mut quilt = RgbImage { width, height, rgb: vec![[0.0; 3]; width as usize * height as usize] };
        (made.samples, made.map_reads) = (0, 0);
        made.anchors = stage.anchors.map(|request| cast_anchors(engine, shot, views, request)).transpose()?;
        if let Some(anchors) = &made.anchors {
            made.anchors_ms += milliseconds(anchors.time);
            (made.samples, made.map_reads) = (anchors.samples, anchors.map_reads);
        }
        for (index, view) in (0..).zip(views) {
            let time = match &made.anchors {
                Some(_) => engine.derive(index as usize)?,
                None => engine.cast(shot, &[*view])?,
            };
            made.views_ms.push(milliseconds(time));
            for cast in engine.read()? {
                quilt.paste(&cast.image.over_background(self.background), display.tile_px(index));
                made.samples += cast.samples;
                made.map_reads += cast.map_reads;
            }
            bar.advance();
        }
        Ok(quilt)
    }

    fn report(
        &self,
        stage: &Stage,
        loaded: &Loaded,
        look: &Look,
        engine: &Engine<'_>,
        made: &Made,
    ) -> Result<(), Failure> {
        let Stage { display, stand, .. } = stage;
        let dims = loaded.volume.grid().dims();
        let quilts = f64::from(stand.pictures());
        let derived_ms = made.views_ms.iter().sum::<f64>() / quilts;
        let anchors_ms = made.anchors_ms / quilts;
        let quilt_ms = anchors_ms + derived_ms;
        let method = if made.anchors.is_some() { "anchors" } else { "each" };
        let settings = &look.settings;
        if self.json {
            let sampling = self.sampling.sampling();
            let limits = display.depth_range(sampling, self.most_disparity);
            let outputs: Vec<String> = made.outputs.iter().map(|path| path.display().to_string()).collect();
            let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
            return print_json(&json!({
                "backend": engine.backend_name(),
                "device": engine.device_name(),
                "driver": engine.driver_name(),
                "dims": dims,
                "display": display,
                "views": display.view_count(),
                "tile_size": display.tile_size_px(),
                "sampling": self.sampling.name(),
                "volume_size_m": stand.volume_size_m,
                "behind_screen_m": -stand.reach_m.start,
                "before_screen_m": stand.reach_m.end,
                "behind_limit_m": limits.behind_m.is_finite().then_some(limits.behind_m),
                "before_limit_m": limits.before_m,
                "mode": look.mode.name(),
                "shading": spec::shading_name(settings.shading),
                "tf": look.transfer_name,
                "window": [settings.window.lo(), settings.window.hi()],
                "method": method,
                "anchors": made.anchors.map(|anchors| anchors.count),
                "slabs": made.anchors.map(|anchors| anchors.slabs),
                "anchor_ms": made.anchors.map(|_| anchors_ms),
                "derived_ms": made.anchors.map(|_| derived_ms),
                "bytes": made.anchors.map_or(0, |anchors| anchors.bytes),
                "view_ms": median(&made.views_ms),
                "quilt_ms": quilt_ms,
                "samples": made.samples,
                "rays": rays(display),
                "skip": made.leaping.to_json(made.map_reads),
                "upload_ms": milliseconds(engine.upload_time()),
                "outputs": outputs,
                "warnings": warnings,
            }));
        }
        eprintln!(
            "{}×{}×{} → {}x{} views of {}x{} {} on {} ({}): {quilt_ms:.0} ms per quilt, {:.1} M samples, {} → {}",
            dims[0],
            dims[1],
            dims[2],
            display.columns,
            display.rows,
            display.tile_size_px()[0],
            display.tile_size_px()[1],
            look.mode.name(),
            engine.backend_name(),
            engine.device_name(),
            made.samples as f64 / 1e6,
            made.leaping.described(made.map_reads),
            described(&made.outputs),
        );
        Ok(())
    }
}

/// Casts the anchors of views.
fn cast_anchors(
    engine: &mut Engine<'_>,
    shot: Shot,
    views: &[View],
    request: AnchorRequest,
) -> Result<AnchorCast, Failure> {
    engine.cast_anchors(shot, views, request.count).map_err(|error| match error {
        Underived::Gpu(error) => error.into(),
        Underived::Refused(why) => Failure::input(format!("--views-method anchors: {why}")),
    })
}

/// Pixels of all views.
fn rays(display: &QuiltDisplay) -> u64 {
    let [width, height] = display.tile_size_px().map(u64::from);
    width * height * u64::from(display.view_count())
}
