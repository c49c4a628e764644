//! The worst refresh of a motion in pictures, the same for each warp (VR Fig. 19).

use super::trace::Trace;
use crate::failure::Failure;
use crate::output::file_in;
use crate::picture::{Bits, dssim_picture, write_png};
use std::path::Path;

/// DSSIM of a white pixel.
const WHITE: f64 = 0.5;

/// Writes what was displayed, the true render, and the DSSIM of the window around each pixel: black is 0, white [`WHITE`] or more.
pub(super) fn write(folder: &Path, trace: &Trace) -> Result<(), Failure> {
    let Some(worst) = &trace.worst else { return Ok(()) };
    let error = dssim_picture(&worst.ssim, &worst.truth, WHITE);
    let case = format!("{}-{}-{}-{}", trace.volume, trace.motion.name(), trace.warp.name(), worst.refresh);
    for (what, picture) in [("displayed", &worst.displayed), ("true", &worst.truth), ("error", &error)] {
        write_png(&file_in(folder, &format!("{case}-{what}.png")), picture, Bits::Eight)?;
    }
    Ok(())
}
