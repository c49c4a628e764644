//! `bench`: what its commands share.

use super::{bench_cast, bench_detail, bench_lightfield, bench_skip, bench_stereo, bench_vr, bench_warp};
use crate::backend::Engine;
use crate::failure::Failure;
use crate::progress::Bar;
use crate::spec;
use crate::transfer_spec::TransferSpec;
use crate::volume_args::print_warnings;
use clap::{Args, Subcommand};
use serde_json::{Value, json};
use std::fmt;
use std::path::Path;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::transfer::BenchmarkRamp;
use wheatstone_core::view::{Frustum, Orbit, Projection, View};
use wheatstone_core::volume::Volume;
use wheatstone_io::{Loaded, read_volume};

/// Measure speed.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench cast bonsai.nii.gz --up A --json\n  \
    wheatstone bench skip beetle:256 --frames 6 --plot plots\n  \
    wheatstone bench detail bonsai.nii.gz --up A --distances 1.2,5\n  \
    wheatstone bench lightfield bonsai.nii.gz --up A --plot plots\n  \
    wheatstone bench stereo bonsai.nii.gz box:256 --up A --plot plots\n  \
    wheatstone bench vr bonsai.nii.gz\n  \
    wheatstone bench warp bonsai.nii.gz --up A --plot plots")]
pub(crate) struct BenchArgs {
    #[command(subcommand)]
    what: BenchCommand,
}

#[derive(Debug, Subcommand)]
enum BenchCommand {
    Cast(bench_cast::CastArgs),
    Detail(bench_detail::DetailArgs),
    Lightfield(Box<bench_lightfield::LightfieldArgs>),
    Skip(bench_skip::SkipBenchArgs),
    Stereo(Box<bench_stereo::StereoBenchArgs>),
    Vr(Box<bench_vr::VrBenchArgs>),
    Warp(Box<bench_warp::WarpBenchArgs>),
}

/// Runs the command.
pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    match &args.what {
        BenchCommand::Cast(args) => bench_cast::run(args),
        BenchCommand::Detail(args) => bench_detail::run(args),
        BenchCommand::Lightfield(args) => bench_lightfield::run(args),
        BenchCommand::Skip(args) => bench_skip::run(args),
        BenchCommand::Stereo(args) => bench_stereo::run(args),
        BenchCommand::Vr(args) => bench_vr::run(args),
        BenchCommand::Warp(args) => bench_warp::run(args),
    }
}

/// Reads a volume file; warnings go to standard error.
pub(super) fn load(file: &Path) -> Result<Loaded, Failure> {
    let loaded = {
        let _spinner = Bar::spinner(format!("reading {}", file.display()));
        read_volume(file)?
    };
    print_warnings(file, &loaded);
    Ok(loaded)
}

/// A volume by its names.
pub(super) struct Opened {
    pub(super) volume: Volume,
    /// What rows call it: the size tells phantoms apart.
    pub(super) name: String,
    /// The benchmark volume that it may be.
    pub(super) benchmark: String,
}

/// A phantom by name and size, or a file.
pub(super) fn open(described: &str) -> Result<Opened, Failure> {
    let phantom =
        described.split_once(':').and_then(|(name, size)| Some((name.parse::<Phantom>().ok()?, size)));
    let Some((phantom, size)) = phantom else {
        let path = Path::new(described);
        let name = name_of(path);
        return Ok(Opened { volume: load(path)?.volume, benchmark: name.clone(), name });
    };
    let dims =
        spec::phantom_dims(size).map_err(|error| Failure::input(format!("{described}: size {error}")))?;
    let _spinner = Bar::spinner(format!("sampling {described}"));
    Ok(Opened {
        volume: phantom.volume(dims).map_err(Failure::input)?,
        name: described.to_owned(),
        benchmark: phantom.name().to_owned(),
    })
}

/// What was measured on.
pub(super) struct Device {
    backend: &'static str,
    name: String,
    driver: String,
}

impl Device {
    pub(super) fn of(engine: &Engine<'_>) -> Self {
        Self { backend: engine.backend_name(), name: engine.device_name(), driver: engine.driver_name() }
    }

    /// One object of a report.
    pub(super) fn to_json(&self) -> Value {
        json!({
            "backend": self.backend, "name": self.name, "driver": self.driver,
            "cpu_threads": rayon::current_num_threads(),
        })
    }
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} ({})", self.backend, self.name, self.driver)
    }
}

/// The name of a file up to its first dot.
pub(super) fn name_of(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// The (first) ramp of the benchmark volume of a name.
pub(super) fn default_transfer(name: &str) -> TransferSpec {
    BenchmarkRamp::of_volume(name).next().map_or(TransferSpec::Ramp([0.0, 1.0]), TransferSpec::Benchmark)
}

/// The DM test camera, turned about the vertical axis.
pub(super) fn test_view(azimuth_rad: f64, size: [u32; 2]) -> Result<View, Failure> {
    let frustum = Frustum::from_fov(1.0, size).map_err(Failure::input)?;
    Ok(Orbit { azimuth_rad, ..Orbit::default() }.view(Projection::Perspective(frustum), size))
}
