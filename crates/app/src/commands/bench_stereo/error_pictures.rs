//! The worst frame of a row in pictures.

use super::row::Row;
use super::turn::Worst;
use crate::failure::Failure;
use crate::output::file_in;
use crate::picture::{Bits, dssim_picture, write_png};
use std::path::Path;

/// DSSIM of a white pixel.
const WHITE: f64 = 0.1;

/// Writes the derived eye, its own cast, and the DSSIM of the window around each pixel: black is 0, white [`WHITE`] or more.
pub(super) fn write(folder: &Path, row: &Row, worst: &Worst) -> Result<(), Failure> {
    let error = dssim_picture(&worst.ssim, &worst.own, WHITE);
    let case = format!(
        "{}-{:.2}-{}-{}-{}",
        row.volume,
        row.distance_m,
        row.shading,
        row.pairing.form.name(),
        row.pairing.quality.name()
    );
    for (what, picture) in [("derived", &worst.derived), ("own", &worst.own), ("error", &error)] {
        let path = file_in(folder, &format!("{case}-{what}.png"));
        write_png(&path, picture, Bits::Eight)?;
    }
    Ok(())
}
