//! `bench`: what its commands share.

use super::{bench_cast, bench_skip};
use crate::failure::Failure;
use crate::progress::Bar;
use crate::transfer_spec::TransferSpec;
use crate::volume_args::print_warnings;
use clap::{Args, Subcommand};
use std::path::Path;
use wheatstone_core::transfer::BenchmarkRamp;
use wheatstone_core::view::{Frustum, Orbit, Projection, View};
use wheatstone_io::{Loaded, read_volume};

/// Measure speed.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench cast bonsai.nii.gz --up A --json\n  \
    wheatstone bench skip beetle:256 --frames 6 --plot plots")]
pub(crate) struct BenchArgs {
    #[command(subcommand)]
    what: BenchCommand,
}

#[derive(Debug, Subcommand)]
enum BenchCommand {
    Cast(bench_cast::CastArgs),
    Skip(bench_skip::SkipBenchArgs),
}

/// Runs the command.
pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    match &args.what {
        BenchCommand::Cast(args) => bench_cast::run(args),
        BenchCommand::Skip(args) => bench_skip::run(args),
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
    let frustum = Frustum::from_fov_y(1.0, size).map_err(Failure::input)?;
    Ok(Orbit { azimuth_rad, ..Orbit::default() }.view(Projection::Perspective(frustum), size))
}
