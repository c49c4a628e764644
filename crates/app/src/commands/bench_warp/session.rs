//! One motion: every refresh by every warp against a true render.

use super::motion::MotionName;
use super::source::Camera;
use super::timeline::Refresh;
use super::trace::{Trace, Worst};
use super::warp::WarpName;
use crate::backend::milliseconds;
use crate::failure::Failure;
use crate::progress::Bar;
use anyhow::Context as _;
use wheatstone_core::head::Display;
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::{SsimMap, dssim};
use wheatstone_core::view::View;

/// What is shown and how.
pub(super) struct Session<'a> {
    pub(super) volume: &'a str,
    pub(super) motion: MotionName,
    pub(super) display: Display,
    /// The projection and size of all views.
    pub(super) like: &'a View,
    pub(super) refreshes: &'a [Refresh],
    pub(super) warps: &'a [WarpName],
    /// Whether the pictures of the refresh that is worst for all warps together are wanted.
    pub(super) keeps_worst: bool,
}

/// Runs the motion once for each warp at once.
pub(super) fn run(
    session: &Session<'_>,
    camera: &mut Camera<'_, '_>,
    bar: &Bar,
) -> Result<Vec<Trace>, Failure> {
    let missed = session.refreshes.iter().filter(|refresh| refresh.is_missed).count();
    let new_trace = |&warp: &WarpName| Trace {
        volume: session.volume.to_owned(),
        motion: session.motion,
        display: session.display,
        warp,
        dssim: Vec::new(),
        warp_ms: Vec::new(),
        cast_ms: Vec::new(),
        missed,
        pose_off: session.refreshes.iter().map(pose_off).collect(),
        worst: None,
    };
    let mut traces: Vec<Trace> = session.warps.iter().map(new_trace).collect();
    let mut displayed: Vec<Option<RgbImage>> = session.warps.iter().map(|_| None).collect();
    let mut picture = None;
    let mut furthest_off = f64::NEG_INFINITY;
    for (number, refresh) in session.refreshes.iter().enumerate() {
        if picture != Some(refresh.picture) {
            camera.begin(refresh.cast_from.view(session.like))?;
            picture = Some(refresh.picture);
        }
        let wanted = refresh.eyes.view(session.like);
        let (truth, cast) = camera.cast(wanted)?;
        let truth = truth.over_background([0.0; 3]);
        let mut maps = Vec::with_capacity(traces.len());
        for (trace, displayed) in traces.iter_mut().zip(&mut displayed) {
            let kept = displayed.take().filter(|_| refresh.is_missed);
            let picture = match kept {
                Some(kept) => kept,
                None => {
                    let warp = camera.warp(trace.warp, &wanted)?;
                    trace.warp_ms.push(milliseconds(warp));
                    camera.warped(trace.warp)?.over_background([0.0; 3])
                }
            };
            trace.cast_ms.push(milliseconds(cast));
            let ssim = SsimMap::new(&picture, &truth).context("the displayed picture")?;
            trace.dssim.push(dssim(ssim.mean()));
            maps.push(ssim);
            *displayed = Some(picture);
        }
        let off: f64 = maps.iter().map(|ssim| dssim(ssim.mean())).sum();
        if session.keeps_worst && off > furthest_off {
            furthest_off = off;
            for ((trace, displayed), ssim) in traces.iter_mut().zip(&displayed).zip(maps) {
                trace.worst = displayed.clone().map(|displayed| Worst {
                    refresh: number,
                    displayed,
                    truth: truth.clone(),
                    ssim,
                });
            }
        }
        bar.advance();
    }
    Ok(traces)
}

/// How far the eyes have turned from where the picture was cast for, degrees, and moved, millimetres.
fn pose_off(refresh: &Refresh) -> [f64; 2] {
    let Refresh { eyes, cast_from, .. } = refresh;
    [eyes.angle_to_rad(cast_from).to_degrees(), 1e3 * eyes.distance_to_m(cast_from)]
}
