//! `calibrate`: measurements of a display of projectors to its description.

use crate::display::ArrayArgs;
use crate::failure::Failure;
use crate::output::{check_apart, check_writable, print_json};
use crate::text_file::read_text_file;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use wheatstone_core::lightfield::calibration::{Calibrated, Fit, Measurements};
use wheatstone_io::write_atomically;

/// Fit the description of a display of projectors to where its beams were measured to pass.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone calibrate measured.json --display designed.json -o fitted.json\n  \
    wheatstone projectors ct.nrrd -o frame.png --display fitted.json\n\n\
    docs/displays.md has the form of the measurements: of each projector at least four pixels with places that their beams pass: \
    different columns and different rows at each of two depths.")]
pub(crate) struct CalibrateArgs {
    /// What was measured.
    #[arg(value_name = "MEASUREMENTS.json")]
    measurements: PathBuf,

    /// The description to write.
    #[arg(short, long, value_name = "OUT.json")]
    output: PathBuf,

    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    display: ArrayArgs,
}

/// Most bytes of measurements: 96 projectors with thousands of beams each.
const MOST_BYTES: u64 = 1 << 26;

/// Runs the command.
pub(crate) fn run(args: &CalibrateArgs) -> Result<(), Failure> {
    check_writable(&args.output, "json")?;
    check_apart([&args.output], [args.measurements.as_path()].into_iter().chain(args.display.file()))?;
    let display = args.display.resolve()?;
    let calibrated = read_text_file(&args.measurements, MOST_BYTES, "measurements", |text| {
        Measurements::from_json(text)?.fit(&display)
    })?;
    write_atomically(&args.output, |writer| writer.write_all(calibrated.array.to_json().as_bytes()))?;
    args.report(&calibrated)
}

impl CalibrateArgs {
    fn report(&self, Calibrated { array, fits }: &Calibrated) -> Result<(), Failure> {
        let worst_m = fits.iter().map(|fit| fit.worst_m).fold(0.0, f64::max);
        let output = self.output.display();
        if self.json {
            let fitted = |fit: &Fit| {
                json!({
                    "id": fit.projector.id,
                    "rms_m": fit.rms_m,
                    "worst_m": fit.worst_m,
                    "worst_correspondence": fit.worst,
                    "emitter_deviation_m": fit.emitter_deviation_m,
                    "image_deviation_m": fit.image_deviation_m,
                })
            };
            return print_json(&json!({
                "projectors": array.projectors().len(),
                "fitted": fits.iter().map(fitted).collect::<Vec<_>>(),
                "worst_m": worst_m,
                "output": output.to_string(),
            }));
        }
        for fit in fits {
            let [rms_mm, worst_mm, edges_mm] =
                [fit.rms_m, fit.worst_m, fit.image_deviation_m].map(|metres| metres * 1e3);
            let [x_mm, y_mm, z_mm] = fit.emitter_deviation_m.map(|metres| metres * 1e3);
            eprintln!(
                "projector {}: misses by {rms_mm:.4} mm rms, {worst_mm:.4} mm at most (correspondences[{}]); standard deviations: emitter \
                {x_mm:.3}, {y_mm:.3}, {z_mm:.3} mm, edges of the image {edges_mm:.3} mm",
                fit.projector.id, fit.worst
            );
        }
        eprintln!(
            "{} of {} projectors fitted, {:.4} mm off at most → {output}",
            fits.len(),
            array.projectors().len(),
            worst_m * 1e3
        );
        Ok(())
    }
}
