//! One turn about the volume, every frame made in every way.

use super::eyes::Eyes;
use crate::backend::{Engine, PairCast, Shot, Underived, milliseconds};
use crate::failure::Failure;
use crate::pairing::Pairing;
use crate::progress::Bar;
use anyhow::Context as _;
use std::time::Duration;
use wheatstone_core::image::{Image, RgbImage};
use wheatstone_core::metrics::{SsimMap, dssim};
use wheatstone_core::view::View;

/// What is made.
pub(super) struct Turn<'a> {
    /// What notes call it.
    pub(super) name: &'a str,
    pub(super) eyes: Eyes,
    /// From the sphere around the volume.
    pub(super) distance_m: f64,
    pub(super) frames: u32,
    /// Whether the pictures of the worst frame are wanted.
    pub(super) keeps_worst: bool,
}

impl Turn<'_> {
    fn views(&self, frame: u32) -> Result<[View; 2], Failure> {
        let turn_rad = std::f64::consts::TAU * f64::from(frame) / f64::from(self.frames);
        self.eyes.views(self.distance_m, turn_rad)
    }
}

/// What a turn of pairs has taken and how far its derived eye was off.
pub(super) struct Tally {
    pub(super) pairing: Pairing,
    /// Of the same frames by a cast of each eye.
    pub(super) left_ms: Vec<f64>,
    pub(super) right_ms: Vec<f64>,
    pub(super) pair_ms: Vec<f64>,
    pub(super) clear_ms: Vec<f64>,
    pub(super) composite_ms: Vec<f64>,
    pub(super) repair_ms: Vec<f64>,
    pub(super) bytes: u64,
    /// Of the whole picture.
    pub(super) dssim: Vec<f64>,
    /// Of the windows that touch the volume.
    pub(super) dssim_covered: Vec<f64>,
    /// Largest difference of a channel of the cast eye from its own cast.
    pub(super) reference_difference: f32,
    pub(super) worst: Option<Worst>,
    is_refused: bool,
}

/// The frame whose derived eye is furthest off.
pub(super) struct Worst {
    dssim: f64,
    pub(super) derived: RgbImage,
    pub(super) own: RgbImage,
    pub(super) ssim: SsimMap,
}

impl Tally {
    fn new(pairing: Pairing) -> Self {
        Self {
            pairing,
            left_ms: Vec::new(),
            right_ms: Vec::new(),
            pair_ms: Vec::new(),
            clear_ms: Vec::new(),
            composite_ms: Vec::new(),
            repair_ms: Vec::new(),
            bytes: 0,
            dssim: Vec::new(),
            dssim_covered: Vec::new(),
            reference_difference: 0.0,
            worst: None,
            is_refused: false,
        }
    }

    /// Makes a pair, times it and returns its pictures; nothing, with a note, if it cannot be made.
    fn cast(
        &mut self,
        engine: &mut Engine<'_>,
        shot: Shot,
        name: &str,
        views: [View; 2],
    ) -> Result<Option<[Image; 2]>, Failure> {
        if self.is_refused {
            return Ok(None);
        }
        match fastest_pair(engine, shot, views, &self.pairing) {
            Ok(pair) => {
                self.pair_ms.push(milliseconds(pair.time));
                self.clear_ms.push(milliseconds(pair.report.clear));
                self.composite_ms.push(milliseconds(pair.report.composite));
                self.repair_ms.push(milliseconds(pair.report.repair));
                self.bytes = self.bytes.max(pair.report.bytes);
                Ok(Some(pictures(engine)?))
            }
            Err(Underived::Refused(why)) => {
                eprintln!(
                    "note: {name}: {} cannot make this pair ({why}): left out",
                    self.pairing.form.name()
                );
                self.is_refused = true;
                Ok(None)
            }
            Err(Underived::Gpu(error)) => Err(error.into()),
        }
    }

    /// Compares a pair, cast eye first, with casts of the same views.
    fn compare(&mut self, pair: [&Image; 2], own: [&Image; 2], keeps_worst: bool) -> Result<(), Failure> {
        self.reference_difference = self.reference_difference.max(largest_difference(pair[0], own[0]));
        let [derived, own_rgb] = [pair[1], own[1]].map(|image| image.over_background([0.0; 3]));
        let ssim = SsimMap::new(&derived, &own_rgb).context("the derived eye")?;
        let is_covered: Vec<bool> =
            pair[1].color.iter().zip(&own[1].color).map(|(a, b)| a[3] > 0.0 || b[3] > 0.0).collect();
        let whole = dssim(ssim.mean());
        self.dssim.push(whole);
        self.dssim_covered.push(dssim(ssim.mean_where(&is_covered).context("covered windows")?));
        if keeps_worst && self.worst.as_ref().is_none_or(|worst| whole > worst.dssim) {
            self.worst = Some(Worst { dssim: whole, derived, own: own_rgb, ssim });
        }
        Ok(())
    }
}

/// Times that each way makes a frame; the fastest counts: other work on a machine adds to a time and never takes from it.
const REPEATS: usize = 3;

fn fastest_cast(engine: &mut Engine<'_>, shot: Shot, view: View) -> Result<Duration, Failure> {
    let mut fastest = engine.cast(shot, &[view])?;
    for _ in 1..REPEATS {
        fastest = fastest.min(engine.cast(shot, &[view])?);
    }
    Ok(fastest)
}

fn fastest_pair(
    engine: &mut Engine<'_>,
    shot: Shot,
    views: [View; 2],
    pairing: &Pairing,
) -> Result<PairCast, Underived> {
    let mut fastest = engine.cast_pair(shot, views, pairing)?;
    for _ in 1..REPEATS {
        let pair = engine.cast_pair(shot, views, pairing)?;
        if pair.time < fastest.time {
            fastest = pair;
        }
    }
    Ok(fastest)
}

fn pictures(engine: &mut Engine<'_>) -> Result<[Image; 2], Failure> {
    let images: Vec<Image> = engine.read()?.into_iter().map(|cast| cast.image).collect();
    let pair = <[Image; 2]>::try_from(images);
    pair.map_err(|images| Failure::Internal(anyhow::anyhow!("{} pictures of a pair", images.len())))
}

fn largest_difference(a: &Image, b: &Image) -> f32 {
    let channels = a.color.iter().flatten().zip(b.color.iter().flatten());
    channels.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Makes each frame by a cast of each eye and by each pairing, after one of each that does not count. Pairings that are refused
/// have no tally.
pub(super) fn measure(
    engine: &mut Engine<'_>,
    shot: Shot,
    turn: &Turn<'_>,
    pairings: &[Pairing],
    bar: &Bar,
) -> Result<Vec<Tally>, Failure> {
    let mut tallies: Vec<Tally> = pairings.iter().copied().map(Tally::new).collect();
    let first = turn.views(0)?;
    for view in first {
        engine.cast(shot, &[view])?;
    }
    for tally in &mut tallies {
        tally.cast(engine, shot, turn.name, first)?;
        *tally = Tally { is_refused: tally.is_refused, ..Tally::new(tally.pairing) };
    }
    bar.advance();
    let mut mono_ms = [Vec::new(), Vec::new()];
    for frame in 0..turn.frames {
        let views = turn.views(frame)?;
        let mut own = [None, None];
        let mut pairs: Vec<Option<[Image; 2]>> = tallies.iter().map(|_| None).collect();
        for way in order(frame as usize, 2 + tallies.len()) {
            if way < 2 {
                mono_ms[way].push(milliseconds(fastest_cast(engine, shot, views[way])?));
                own[way] = engine.read()?.pop().map(|cast| cast.image);
            } else {
                pairs[way - 2] = tallies[way - 2].cast(engine, shot, turn.name, views)?;
            }
        }
        let [Some(left), Some(right)] = &own else { continue };
        for (tally, pair) in tallies.iter_mut().zip(&pairs) {
            if let Some([reference, derived]) = pair {
                tally.compare([reference, derived], [left, right], turn.keeps_worst)?;
            }
        }
        bar.advance();
    }
    tallies.retain(|tally| !tally.is_refused);
    for tally in &mut tallies {
        [tally.left_ms, tally.right_ms] = mono_ms.clone();
    }
    Ok(tallies)
}

/// The order of the ways in a frame: who is first and who comes after whom changes from frame to frame.
fn order(frame: usize, ways: usize) -> impl Iterator<Item = usize> {
    let strides: Vec<usize> = (1..ways).filter(|&stride| gcd(stride, ways) == 1).collect();
    let stride = strides[frame % strides.len()];
    let first = frame / strides.len();
    (0..ways).map(move |i| (first + i * stride) % ways)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_has_every_way_and_neighbours_change() {
        for ways in 2..9 {
            let orders: Vec<Vec<usize>> = (0..4 * ways).map(|frame| order(frame, ways).collect()).collect();
            for of_frame in &orders {
                let mut sorted = of_frame.clone();
                sorted.sort_unstable();
                assert_eq!(sorted, (0..ways).collect::<Vec<_>>());
            }
            let before_first: std::collections::BTreeSet<usize> = orders
                .iter()
                .filter_map(|of_frame| {
                    let at = of_frame.iter().position(|&way| way == 0)?;
                    at.checked_sub(1).map(|before| of_frame[before])
                })
                .collect();
            assert!(ways == 2 || before_first.len() > 1, "{ways}: {before_first:?}");
        }
    }
}
