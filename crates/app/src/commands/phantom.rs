//! `phantom`: an analytic volume to a file.

use crate::failure::Failure;
use crate::output::check_writable;
use crate::progress::Bar;
use crate::spec;
use clap::Args;
use std::path::PathBuf;
use wheatstone_core::phantom::Phantom;
use wheatstone_io::write_nrrd;

/// Write an analytic test volume as NRRD.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  \
    wheatstone phantom shepp-logan --size 128 -o head.nrrd\n  \
    wheatstone phantom ramp --size 64x32x16 -o ramp.nrrd\n  \
    wheatstone phantom wedding-cake --size 200x150x110 -o cake.nrrd\n\n\
    Phantoms: {}.", Phantom::names()))]
pub(crate) struct PhantomArgs {
    /// Name of the phantom.
    #[arg(value_name = "NAME")]
    phantom: Phantom,

    /// Voxels along every axis, or along each.
    #[arg(long, value_name = "N|XxYxZ", default_value = "128", value_parser = spec::phantom_dims, allow_negative_numbers = true)]
    size: [usize; 3],

    /// The .nrrd file to write.
    #[arg(short, long, value_name = "OUT.nrrd")]
    output: PathBuf,
}

/// Runs the command.
pub(crate) fn run(args: &PhantomArgs) -> Result<(), Failure> {
    check_writable(&args.output, "nrrd")?;
    let volume = {
        let _spinner = Bar::spinner(format!("sampling {}", args.phantom));
        args.phantom.volume(args.size).map_err(Failure::input)?
    };
    let _spinner = Bar::spinner(format!("writing {}", args.output.display()));
    write_nrrd(&args.output, &volume)?;
    let [x, y, z] = args.size;
    eprintln!(
        "{} of {x}×{y}×{z} {} voxels → {}",
        args.phantom,
        volume.voxels().voxel_type(),
        args.output.display()
    );
    Ok(())
}
