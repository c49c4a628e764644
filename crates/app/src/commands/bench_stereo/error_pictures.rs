//! The worst frame of a row in pictures.

use super::row::Row;
use super::turn::Worst;
use crate::failure::Failure;
use crate::output::file_in;
use crate::picture::{Bits, write_png};
use std::path::Path;
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::dssim;

/// DSSIM of a white pixel.
const WHITE: f64 = 0.1;

/// Writes the derived eye, its own cast, and the DSSIM of the window around each pixel: black is 0, white [`WHITE`] or more.
pub(super) fn write(folder: &Path, row: &Row, worst: &Worst) -> Result<(), Failure> {
    let grey = |ssim: f64| [(dssim(ssim) / WHITE).clamp(0.0, 1.0) as f32; 3];
    let error = RgbImage {
        width: worst.own.width,
        height: worst.own.height,
        rgb: worst.ssim.around_pixels().into_iter().map(grey).collect(),
    };
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
