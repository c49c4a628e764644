//! `bench warp`: how far what a display shows is from what its eyes should see, by the protocol of VR §6.2.

mod aim;
mod cells;
mod charts;
mod costs;
mod live;
mod motion;
mod pictures;
mod session;
mod source;
mod timeline;
mod trace;
mod warp;

use super::bench::{Device, Opened, default_transfer, open};
use crate::backend::{BackendChoice, Engine, note_fallback};
use crate::camera::Up;
use crate::failure::Failure;
use crate::layering::{Layering, LayeringArgs};
use crate::output::{make_folder, print, print_json};
use crate::progress::Bar;
use crate::skipping::{SkipArgs, SkipName};
use crate::spec;
use crate::transfer_spec::{self, TransferSpec};
use aim::AimName;
use cells::Cells;
use clap::{Args, ValueEnum};
use costs::{Costs, Timed};
use live::Keeping;
use motion::{Extent, MotionName};
use serde_json::json;
use session::Session;
use source::Camera;
use std::path::PathBuf;
use timeline::Pace;
use trace::Trace;
use warp::WarpName;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::head::{Display, Pose};
use wheatstone_core::scene::{Placement, Settings, Shading};
use wheatstone_core::view::{Frustum, Orbit, Projection, world_from_patient};
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::Gpu;

/// Radius of the sphere around a cube of 1 m.
const RADIUS_M: f64 = 0.866;

/// Error of what a head-mounted display shows while the head moves, with and without warping.
///
/// Simulated time: a head turns about its neck, moves sideways, or does both, eased by a cosine, within one second. Pictures are cast
/// a few cells per refresh, as many as fit in what is left of it by costs that go with their samples and scatter by 30 %; at each refresh
/// the newest complete picture is warped to where the eyes are and compared with a true render from there. Results are the same on
/// every machine within rounding, but for the times of warps.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench warp bonsai.nii.gz --up A --plot plots\n  \
    wheatstone bench warp shepp-logan:64 --size 256x256 --motions translation --warps none,grid,volumetric --json\n  \
    wheatstone bench warp mni152.nii.gz --render-ms 30 --error-pictures errors")]
pub(crate) struct WarpBenchArgs {
    /// Volume files, or phantoms with their size.
    #[arg(value_name = "FILE|PHANTOM:N", required = true)]
    volumes: Vec<String>,

    /// Transfer function [default: the (first) ramp of the benchmark volume of the name, else ramp:0..1].
    #[arg(long, value_name = "SPEC", value_parser = transfer_spec::parse)]
    tf: Option<TransferSpec>,

    /// Shading.
    #[arg(long, value_name = "SHADING", default_value = "none", value_parser = spec::shading)]
    shading: Shading,

    /// Width and height of the eye's picture, pixels.
    #[arg(long, value_name = "WxH", default_value = "768x768", value_parser = spec::picture_size)]
    size: [u32; 2],

    /// Field of view of the shorter side of the picture, degrees.
    #[arg(long, value_name = "DEG", default_value_t = 90.0, value_parser = spec::within(1.0..=170.0), allow_negative_numbers = true)]
    fov_deg: f64,

    /// Distance from the eye, in the middle of the motion, to the sphere around a cube of 1 m, metres.
    #[arg(long, value_name = "M", default_value_t = 0.6, value_parser = spec::within(0.0..=1000.0), allow_negative_numbers = true)]
    distance: f64,

    /// How the head moves.
    #[arg(
        long,
        value_name = "MOTIONS",
        value_enum,
        value_delimiter = ',',
        default_value = "rotation,translation,both"
    )]
    motions: Vec<MotionName>,

    /// What is done with old pictures.
    #[arg(long, value_name = "WARPS", value_enum, value_delimiter = ',')]
    warps: Vec<WarpName>,

    #[command(flatten)]
    layering: LayeringArgs,

    /// Which pose pictures are cast for: that at which they will be shown first, as if it were known, or as it is predicted.
    #[arg(long, value_enum, default_value_t = AimName::Known)]
    aim: AimName,

    /// Turn of the head within the second, degrees.
    #[arg(long, value_name = "DEG", default_value_t = 30.0, value_parser = spec::within(-180.0..=180.0), allow_negative_numbers = true)]
    turn_deg: f64,

    /// Way of the head sideways within the second, metres.
    #[arg(long, value_name = "M", default_value_t = 0.2, value_parser = spec::within(-10.0..=10.0), allow_negative_numbers = true)]
    sideways: f64,

    /// Refreshes of the display per second.
    #[arg(long, value_name = "HZ", default_value_t = 90.0, value_parser = spec::within(1.0..=1000.0), allow_negative_numbers = true)]
    refresh_hz: f64,

    /// Time that casting a picture takes, milliseconds.
    #[arg(long, value_name = "MS", default_value_t = 45.0, value_parser = spec::within(0.1..=10_000.0), allow_negative_numbers = true)]
    render_ms: f64,

    /// Cast in real time on a display of which a picture takes so many refreshes (5 to 20, or as given) [default: 10]; the
    /// options above do not count then.
    #[arg(long, value_name = "REFRESHES", num_args = 0..=1, default_missing_value = "10", value_parser = spec::within(1.0..=100.0), conflicts_with_all = ["refresh_hz", "render_ms"])]
    live: Option<f64>,

    /// Time of each refresh that is kept for the warp, milliseconds; less than a refresh.
    #[arg(long, value_name = "MS", default_value_t = 2.0, value_parser = spec::within(0.0..=1000.0), allow_negative_numbers = true)]
    warp_ms: f64,

    /// Where to cast and warp: auto takes a GPU, software Vulkan included, if there is one.
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,

    #[command(flatten)]
    skip: SkipArgs,

    /// Which patient direction points up; A gives a plain array's +y.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Up::S)]
    up: Up,

    /// Write a chart of each volume and motion to this folder: DSSIM over time.
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,

    /// Write the refresh of each motion that is worst in the mean over the warps to this folder: what each warp displayed, the true
    /// render, and where they differ.
    #[arg(long, value_name = "DIR")]
    error_pictures: Option<PathBuf>,

    /// Print one JSON object on standard output instead of a table.
    #[arg(long)]
    json: bool,
}

/// What was measured of all volumes.
#[derive(Default)]
struct Measured {
    traces: Vec<Trace>,
    costs: Vec<Costs>,
    keepings: Vec<Keeping>,
}

/// Runs the command.
pub(crate) fn run(args: &WarpBenchArgs) -> Result<(), Failure> {
    [&args.plot, &args.error_pictures].into_iter().flatten().try_for_each(|folder| make_folder(folder))?;
    let pace = args.pace()?;
    let layering = args.layering.resolve()?;
    let mut device = None;
    let mut measured = Measured::default();
    for volume in &args.volumes {
        device = Some(args.measure_volume(volume, &pace, &layering, &mut measured)?);
    }
    let Measured { traces, costs, keepings } = measured;
    if let Some(folder) = &args.plot {
        charts::draw(folder, &traces)?;
    }
    if args.json {
        return print_json(&json!({
            "device": device.as_ref().map(Device::to_json),
            "size": args.size,
            "layers": layering.to_json(),
            "refresh_hz": args.live.is_none().then_some(args.refresh_hz),
            "render_ms": args.live.is_none().then_some(args.render_ms),
            "live": args.live.map(|_| keepings.iter().map(Keeping::to_json).collect::<Vec<_>>()),
            "costs": costs.iter().flat_map(Costs::to_json).collect::<Vec<_>>(),
            "rows": traces.iter().map(Trace::to_json).collect::<Vec<_>>(),
        }));
    }
    let mut tables: Vec<String> = device.iter().map(Device::to_string).collect();
    tables.push(trace::to_table(&traces));
    tables.push(costs::to_table(&costs));
    tables.extend(keepings.iter().map(Keeping::to_line));
    print(&tables.join("\n"))
}

impl WarpBenchArgs {
    fn pace(&self) -> Result<Pace, Failure> {
        let display = Display::new(self.refresh_hz).map_err(Failure::input)?;
        let reserve_s = 1e-3 * self.warp_ms;
        if reserve_s >= display.period_s() {
            return Err(Failure::input(format!(
                "--warp-ms {}: a refresh at {} Hz has {:.3} ms",
                self.warp_ms,
                self.refresh_hz,
                1e3 * display.period_s()
            )));
        }
        Ok(Pace { display, render_s: 1e-3 * self.render_ms, reserve_s })
    }

    fn measure_volume(
        &self,
        described: &str,
        pace: &Pace,
        layering: &Layering,
        measured: &mut Measured,
    ) -> Result<Device, Failure> {
        let Opened { volume, name, benchmark } = open(described)?;
        let transfer = self.tf.clone().unwrap_or_else(|| default_transfer(&benchmark));
        let resolved = transfer.resolve(&volume, None)?;
        let placement = Placement::new(&volume, world_from_patient(volume.grid(), self.up.direction()));
        let settings =
            Settings { shading: self.shading, ..Settings::new(resolved.window, resolved.transfer.clone()) };
        let storage = StorageKind::lossless_for(&volume);
        let mut engine = self.engine(&volume, storage)?;
        let parameters = CastParameters::new(&settings, &placement);
        let skipping = self.skip.resolve(SkipName::Auto)?;
        let shot = engine.prepare(&parameters, &skipping)?;
        let mut shaded = |shading| {
            let settings = Settings { shading, ..settings.clone() };
            engine.prepare(&CastParameters::new(&settings, &placement), &skipping)
        };
        let shots = [shaded(Shading::None)?, shaded(Shading::Shadow)?];
        let frustum = Frustum::from_fov(self.fov_deg.to_radians(), self.size).map_err(Failure::input)?;
        let orbit = Orbit { distance_m: self.distance + RADIUS_M, ..Orbit::default() };
        let middle = orbit.view(Projection::Perspective(frustum), self.size);
        let extent = Extent { turn_rad: self.turn_deg.to_radians(), sideways_m: self.sideways };
        let warps = if self.warps.is_empty() { WarpName::value_variants() } else { &self.warps };
        let layering = warps.contains(&WarpName::Volumetric).then_some(layering);
        let cells = Cells::of(&mut engine, shot, &middle)?;
        let mut camera = Camera::new(&mut engine, shot, (&volume, storage, &parameters), middle, layering)?;
        let timed = Timed { volume: &name, shots, middle: &middle, extent, warps };
        measured.costs.push(costs::measure(&timed, &mut camera)?);
        for &motion in &self.motions {
            let path = motion.about(Pose::of(&middle), extent)?;
            let mut display = pace.display;
            let refreshes = match self.live {
                None => timeline::refreshes(&path, self.aim, pace, &cells)?,
                Some(refreshes) => {
                    let mut engine = camera.engine.live(shot)?;
                    let pace = live::fitting_pace(&mut engine, &path, &middle, refreshes, pace.reserve_s)?;
                    let case = format!("{name}, {}", motion.name());
                    let moves = (&path, self.aim);
                    let (refreshes, keeping) = live::refreshes(&mut engine, moves, &middle, &pace, case)?;
                    measured.keepings.push(keeping);
                    display = pace.display;
                    refreshes
                }
            };
            let session = Session {
                volume: &name,
                motion,
                display,
                like: &middle,
                refreshes: &refreshes,
                warps,
                keeps_worst: self.error_pictures.is_some(),
            };
            let bar = Bar::new(format!("{name}, {}", motion.name()), refreshes.len() as u64);
            for trace in session::run(&session, &mut camera, &bar)? {
                if let Some(folder) = &self.error_pictures {
                    pictures::write(folder, &trace)?;
                }
                measured.traces.push(trace);
            }
        }
        Ok(Device::of(&engine))
    }

    fn engine<'v>(&self, volume: &'v Volume, storage: StorageKind) -> Result<Engine<'v>, Failure> {
        let on_gpu = || Engine::gpu(Gpu::open_best()?, volume, storage);
        match self.backend {
            BackendChoice::Cpu => Ok(Engine::cpu(volume, storage)),
            BackendChoice::Gpu => Ok(on_gpu()?),
            BackendChoice::Auto => Ok(on_gpu().unwrap_or_else(|error| {
                note_fallback(&error);
                Engine::cpu(volume, storage)
            })),
        }
    }
}
