//! `wheatstone`: volume files to pictures for one eye or two, from the command line.
//!
//! One file per command in `commands`; what several commands share lies beside this file. `docs/cli.md` is the
//! reference.

mod backend;
mod camera;
mod commands;
mod display;
mod failure;
mod heat_map;
mod interrupt;
mod layering;
mod look;
mod many_views;
mod output;
mod pair_cost;
mod pairing;
mod picture;
mod plot;
mod progress;
mod quilt_file;
mod shipped;
mod skipping;
mod spec;
mod stand;
mod text_file;
mod transfer_spec;
mod viewer;
mod volume_args;
mod vr;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Volume rendering for both eyes: scans and simulations to mono and stereo pictures.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Examples:\n  \
        wheatstone demo\n  \
        wheatstone info head.nii.gz\n  \
        wheatstone render head.nii.gz -o head.png --tf mri-brain-t1 --shading phong\n  \
        wheatstone view head.nii.gz\n\n\
        Exit codes: 0 done, 1 internal or GPU failure, 2 bad input or bad usage."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Info(commands::info::InfoArgs),
    Render(Box<commands::render::RenderArgs>),
    Quilt(Box<commands::quilt::QuiltArgs>),
    Projectors(Box<commands::projectors::ProjectorsArgs>),
    Simulate(commands::simulate::SimulateArgs),
    Calibrate(commands::calibrate::CalibrateArgs),
    Compare(commands::compare::CompareArgs),
    Phantom(commands::phantom::PhantomArgs),
    Doctor(commands::doctor::DoctorArgs),
    Demo(commands::demo::DemoArgs),
    Bench(commands::bench::BenchArgs),
    View(commands::view::ViewArgs),
    Vr(commands::vr::VrArgs),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Info(args) => commands::info::run(&args),
        Command::Render(args) => commands::render::run(&args),
        Command::Quilt(args) => commands::quilt::run(&args),
        Command::Projectors(args) => commands::projectors::run(&args),
        Command::Simulate(args) => commands::simulate::run(&args),
        Command::Calibrate(args) => commands::calibrate::run(&args),
        Command::Compare(args) => commands::compare::run(&args),
        Command::Phantom(args) => commands::phantom::run(&args),
        Command::Doctor(args) => commands::doctor::run(&args),
        Command::Demo(args) => commands::demo::run(&args),
        Command::Bench(args) => commands::bench::run(&args),
        Command::View(args) => commands::view::run(&args),
        Command::Vr(args) => commands::vr::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code()
        }
    }
}
