//! `compare`: how far two pictures are apart.

use crate::failure::Failure;
use crate::output::{print, print_json};
use crate::picture::read_png;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use wheatstone_core::metrics::compare;

/// Compare two PNG pictures of one size: SSIM, DSSIM, PSNR and the largest difference.
///
/// 8 or 16 bits, grey or colour; transparent pictures are put over black.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone compare gpu.png cpu.png\n  \
    wheatstone compare a.png b.png --json\n\n\
    SSIM has uniform 8x8 windows, K1 = 0.01, K2 = 0.03; DSSIM = (1 - SSIM) / 2. The JSON's psnr is null for equal pictures.")]
pub(crate) struct CompareArgs {
    /// The first picture.
    #[arg(value_name = "A.png")]
    first: PathBuf,

    /// The second picture.
    #[arg(value_name = "B.png")]
    second: PathBuf,

    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(args: &CompareArgs) -> Result<(), Failure> {
    let (first, second) = (read_png(&args.first)?, read_png(&args.second)?);
    let found = compare(&first, &second).map_err(Failure::input)?;
    if args.json {
        let psnr = found.psnr_db.is_finite().then_some(found.psnr_db);
        return print_json(&json!({
            "ssim": found.ssim,
            "dssim": found.dssim(),
            "psnr": psnr,
            "max_abs": found.max_abs,
        }));
    }
    print(&format!(
        "ssim     {:.6}\ndssim    {:.6}\npsnr     {:.2} dB\nmax_abs  {:.6}",
        found.ssim,
        found.dssim(),
        found.psnr_db,
        found.max_abs
    ))
}
