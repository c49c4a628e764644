//! The charts of VR Fig. 18.

use super::trace::Trace;
use crate::failure::Failure;
use crate::output::file_in;
use crate::plot::{Labels, Line, even_chart};
use std::path::Path;

/// DSSIM over time, for each volume and motion.
pub(super) fn draw(folder: &Path, traces: &[Trace]) -> Result<(), Failure> {
    for traces in traces.chunk_by(|a, b| a.volume == b.volume && a.motion == b.motion) {
        let [Trace { volume, motion, display, .. }, ..] = traces else { continue };
        let line = |trace: &Trace| Line {
            name: trace.warp.name().to_owned(),
            points: (0_u64..).zip(&trace.dssim).map(|(i, &y)| (display.refresh_s(i), y)).collect(),
        };
        even_chart(
            &file_in(folder, &format!("{volume}-{}.svg", motion.name())),
            &Labels { title: &format!("{volume}, {}", motion.name()), x: "time (s)", y: "DSSIM" },
            &traces.iter().map(line).collect::<Vec<_>>(),
        )?;
    }
    Ok(())
}
