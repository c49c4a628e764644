//! `bench detail`: what level of detail saves near and far, what leaping to what the last picture saw first does, and what both do to
//! the picture.

use super::bench::{Device, Opened, default_transfer, open};
use crate::backend::{BackendChoice, Engine, Job, Shot, median, milliseconds};
use crate::camera::Up;
use crate::failure::Failure;
use crate::output::{print, print_json};
use crate::progress::Bar;
use crate::skipping::{GradientMapName, Skipping};
use crate::spec;
use crate::transfer_spec::{self, TransferSpec};
use clap::Args;
use glam::{DAffine3, DQuat, DVec3};
use serde_json::{Value, json};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::compare;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::skip::{Skip, SkipRequest};
use wheatstone_core::view::{Frustum, Orbit, Projection, View, world_from_patient};
use wheatstone_core::volume::StorageKind;

/// Rays along each side of a pixel of the pictures that all are compared with.
const RAYS_ACROSS: u32 = 4;

/// Frame times and errors with and without level of detail and leaping to the first hits of the last frame, skipping nothing and empty
/// blocks, from several distances.
///
/// Rows `leaps` are of casts whose rays start by what was seen first from where the head was before. Rows `first` are of casts whose rays
/// end with the first visible sample: leaping to it cannot save more than they take.
///
/// Each frame is made in every way in turn, after the one from where the head was before, which is not timed; times are medians. Rays end at an opacity of 0.99. Errors are DSSIM: from the picture at full
/// detail, and from one of sixteen rays per pixel and two samples per voxel.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench detail bonsai.nii.gz --up A\n  \
    wheatstone bench detail beetle:256 --distances 1.2,5,12 --json")]
pub(crate) struct DetailArgs {
    /// Volume files, or phantoms with their size.
    #[arg(value_name = "FILE|PHANTOM:N", required = true)]
    volumes: Vec<String>,

    /// Distances of the eye from the volume's centre, metres; its longest side is 1 m.
    #[arg(long, value_name = "M", value_delimiter = ',', default_value = "1.2,5", value_parser = spec::within(0.0..=1000.0))]
    distances: Vec<f64>,

    /// How far the head has turned since the picture before, degrees.
    #[arg(long, value_name = "DEG", default_value = "1.5", value_parser = spec::within(-180.0..=180.0), allow_negative_numbers = true)]
    turn: f64,

    /// How far it has moved sideways since then, metres.
    #[arg(long, value_name = "M", default_value = "0.015", value_parser = spec::within(-10.0..=10.0), allow_negative_numbers = true)]
    sideways: f64,

    /// Pixels that a voxel and a step cover about.
    #[arg(long, value_name = "PIXELS", default_value = "1", value_parser = spec::within(0.1..=100.0))]
    pixels: f64,

    /// One-dimensional transfer function [default: the ramp of the benchmark volume of the name, else ramp:0..1].
    #[arg(long, value_name = "SPEC", value_parser = transfer_spec::parse)]
    tf: Option<TransferSpec>,

    /// Width and height of the picture, pixels.
    #[arg(long, value_name = "WxH", default_value = "768x768", value_parser = spec::picture_size)]
    size: [u32; 2],

    /// Frames that are timed.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    frames: u32,

    /// What casts the rays.
    #[arg(long, value_enum, default_value_t = BackendChoice::Gpu)]
    backend: BackendChoice,

    /// Which patient direction points up; A gives a plain array's +y.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Up::S)]
    up: Up,

    /// Print one JSON object on standard output instead of a table.
    #[arg(long)]
    json: bool,
}

/// Opacity at which rays end that stop at the first visible sample.
const FIRST_ALPHA: f32 = 1e-6;

/// What is cast.
#[derive(Clone, Copy, PartialEq, Eq)]
enum What {
    /// The picture at full detail.
    Full,
    /// The picture with level of detail.
    Levels,
    /// Rays from the first hits of a picture before.
    Leaps,
    /// Rays up to the first visible sample.
    First,
}

/// What is cast, and what rays leap over.
#[derive(Clone, Copy)]
struct Way {
    what: What,
    skip: &'static str,
}

/// In the order of the table: the first is the measure of the others that leap over the same.
const WHATS: [What; 4] = [What::Full, What::Levels, What::Leaps, What::First];

/// One line of the table.
struct Row {
    volume: String,
    distance_m: f64,
    way: Way,
    frame_ms: f64,
    /// Its time over that at full detail.
    of_full: f64,
    samples_per_ray: f64,
    /// From the picture at full detail and from the truth, if it is a picture.
    dssims: Option<[f64; 2]>,
}

/// Runs the command.
pub(crate) fn run(args: &DetailArgs) -> Result<(), Failure> {
    let (mut rows, mut device) = (Vec::new(), None);
    for volume in &args.volumes {
        device = Some(args.measure_volume(volume, &mut rows)?);
    }
    if args.json {
        return print_json(&json!({
            "device": device.as_ref().map(Device::to_json),
            "size": args.size,
            "frames": args.frames,
            "pixels": args.pixels,
            "turn_deg": args.turn,
            "sideways_m": args.sideways,
            "rows": rows.iter().map(Row::to_json).collect::<Vec<_>>(),
        }));
    }
    print(&to_table(device.as_ref(), &rows))
}

impl DetailArgs {
    fn measure_volume(&self, described: &str, rows: &mut Vec<Row>) -> Result<Device, Failure> {
        let Opened { mut volume, name, benchmark } = open(described)?;
        let transfer = self.tf.clone().unwrap_or_else(|| default_transfer(&benchmark));
        let resolved = transfer.resolve(&volume, None)?;
        if resolved.transfer.is_2d() {
            return Err(Failure::input("bench detail needs a transfer function of one dimension"));
        }
        volume.fill_non_finite(resolved.window.lo());
        let settings = Settings::new(resolved.window, resolved.transfer);
        let placement = Placement::new(&volume, world_from_patient(volume.grid(), self.up.direction()));
        let parameters = CastParameters::new(&settings, &placement);
        let finer = CastParameters { sampling_factor: 2.0, ..parameters.clone() };

        let coarser = volume.coarser_levels();
        let job = Job { rays: u64::MAX, samples_per_ray: 1.0, needs_gpu: false };
        let mut engine = Engine::open(self.backend, &job, &volume, StorageKind::lossless_for(&volume))?;
        engine.add_levels(&coarser)?;
        let to_first = CastParameters { termination_alpha: FIRST_ALPHA, ..parameters.clone() };
        let detail = LevelOfDetail::Pixels(self.pixels);
        let shots = ways()
            .map(|way| match way.what {
                What::Full => engine.prepare(&parameters, &way.skipping()),
                What::Levels => engine.prepare_detail(&parameters, &way.skipping(), detail),
                What::Leaps => engine.prepare_leaping(&parameters, &way.skipping()),
                What::First => engine.prepare(&to_first, &way.skipping()),
            })
            .collect::<Result<Vec<_>, _>>()?;
        let truth = engine.prepare(&finer, &Skipping::AUTO)?;
        for &distance_m in &self.distances {
            rows.extend(self.measure(&name, distance_m, &mut engine, &shots, truth)?);
        }
        Ok(Device::of(&engine))
    }

    fn measure(
        &self,
        name: &str,
        distance_m: f64,
        engine: &mut Engine<'_>,
        shots: &[Shot],
        truth: Shot,
    ) -> Result<Vec<Row>, Failure> {
        let view = self.view(distance_m, self.size)?;
        let bar = Bar::new(format!("{name}, {distance_m} m"), u64::from(self.frames));
        let last = self.before(&view);
        let cast = |engine: &mut Engine<'_>, way: Way, shot: Shot| match way.what {
            What::Leaps => engine.cast_after(shot, &last, &view),
            What::Full | What::Levels | What::First => {
                engine.cast(shot, &[last])?;
                engine.cast(shot, &[view])
            }
        };
        let mut casts = Vec::new();
        for (way, &shot) in ways().zip(shots) {
            cast(engine, way, shot)?;
            casts.extend(engine.read()?);
        }
        let mut times_ms = vec![Vec::new(); shots.len()];
        for _ in 0..self.frames {
            for ((way, &shot), times_ms) in ways().zip(shots).zip(&mut times_ms) {
                times_ms.push(milliseconds(cast(engine, way, shot)?));
            }
            bar.advance();
        }
        engine.cast(truth, &[self.view(distance_m, self.size.map(|side| RAYS_ACROSS * side))?])?;
        let truth = pictured(&engine.read()?[0]).averaged(RAYS_ACROSS);
        let medians_ms: Vec<f64> = times_ms.iter().map(|times_ms| median(times_ms)).collect();
        let pictures: Vec<RgbImage> = casts.iter().map(pictured).collect();
        let rays = f64::from(self.size[0]) * f64::from(self.size[1]);
        let row = |(i, way): (usize, Way)| -> Result<Row, Failure> {
            let full = i - i % WHATS.len();
            let dssim = |from: &RgbImage| -> Result<f64, Failure> {
                Ok(compare(&pictures[i], from).map_err(Failure::input)?.dssim())
            };
            let is_picture = way.what != What::First;
            let dssims = || Ok::<_, Failure>([dssim(&pictures[full])?, dssim(&truth)?]);
            Ok(Row {
                volume: name.to_owned(),
                distance_m,
                way,
                frame_ms: medians_ms[i],
                of_full: medians_ms[i] / medians_ms[full].max(1e-3),
                samples_per_ray: casts[i].samples as f64 / rays,
                dssims: is_picture.then(dssims).transpose()?,
            })
        };
        ways().enumerate().map(row).collect()
    }

    /// The view from where the head was before.
    fn before(&self, view: &View) -> View {
        let turn = DQuat::from_rotation_y(-self.turn.to_radians());
        let now_from_before = DAffine3::from_rotation_translation(turn, -self.sideways * DVec3::X);
        View { view_from_world: now_from_before.inverse() * view.view_from_world, ..*view }
    }

    fn view(&self, distance_m: f64, size: [u32; 2]) -> Result<View, Failure> {
        let frustum = Frustum::from_fov(1.0, size).map_err(Failure::input)?;
        let orbit = Orbit { azimuth_rad: 0.4, elevation_rad: 0.2, distance_m };
        Ok(orbit.view(Projection::Perspective(frustum), size))
    }
}

fn pictured(cast: &Cast) -> RgbImage {
    cast.image.over_background([0.0; 3])
}

/// Every way.
fn ways() -> impl Iterator<Item = Way> {
    ["none", "auto"].into_iter().flat_map(|skip| WHATS.map(|what| Way { what, skip }))
}

impl What {
    fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Levels => "levels",
            Self::Leaps => "leaps",
            Self::First => "first",
        }
    }
}

impl Way {
    fn skipping(self) -> Skipping {
        let skip = if self.skip == "none" { Skip::None } else { Skip::Auto };
        Skipping { request: SkipRequest { skip, block_size: None }, gradient_map: GradientMapName::None }
    }
}

impl Row {
    fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "distance_m": self.distance_m,
            "skip": self.way.skip,
            "what": self.way.what.name(),
            "frame_ms": self.frame_ms,
            "of_full": self.of_full,
            "samples_per_ray": self.samples_per_ray,
            "dssim_from_full": self.dssims.map(|[full, _]| full),
            "dssim_from_truth": self.dssims.map(|[_, truth]| truth),
        })
    }
}

fn to_table(device: Option<&Device>, rows: &[Row]) -> String {
    let mut lines: Vec<String> = device.map(Device::to_string).into_iter().collect();
    lines.push(format!(
        "{:<14} {:>5} {:<5} {:<6} {:>9} {:>7} {:>11} {:>10} {:>10}",
        "volume", "m", "skip", "what", "frame ms", "/ full", "samples/ray", "from full", "from truth"
    ));
    for row in rows {
        let dssim =
            |of: usize| row.dssims.map_or_else(|| "-".to_owned(), |dssims| format!("{:.5}", dssims[of]));
        lines.push(format!(
            "{:<14} {:>5} {:<5} {:<6} {:>9.2} {:>7.3} {:>11.2} {:>10} {:>10}",
            row.volume,
            row.distance_m,
            row.way.skip,
            row.way.what.name(),
            row.frame_ms,
            row.of_full,
            row.samples_per_ray,
            dssim(0),
            dssim(1),
        ));
    }
    lines.join("\n")
}
