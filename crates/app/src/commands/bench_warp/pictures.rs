//! The worst refresh of a trace in pictures (VR Fig. 19).

use super::trace::Trace;
use crate::failure::Failure;
use crate::output::file_in;
use crate::picture::{Bits, write_png};
use std::path::Path;
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::dssim;

/// DSSIM of a white pixel.
const WHITE: f64 = 0.5;

/// Writes what was displayed, the true render, and the DSSIM of the window around each pixel: black is 0, white [`WHITE`] or more.
pub(super) fn write(folder: &Path, trace: &Trace) -> Result<(), Failure> {
    let Some(worst) = &trace.worst else { return Ok(()) };
    let grey = |ssim: f64| [(dssim(ssim) / WHITE).clamp(0.0, 1.0) as f32; 3];
    let error = RgbImage {
        width: worst.truth.width,
        height: worst.truth.height,
        rgb: worst.ssim.around_pixels().into_iter().map(grey).collect(),
    };
    let case = format!("{}-{}-{}-{}", trace.volume, trace.motion.name(), trace.warp.name(), worst.refresh);
    for (what, picture) in [("displayed", &worst.displayed), ("true", &worst.truth), ("error", &error)] {
        write_png(&file_in(folder, &format!("{case}-{what}.png")), picture, Bits::Eight)?;
    }
    Ok(())
}
