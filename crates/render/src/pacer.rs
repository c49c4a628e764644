//! How much of a picture one dispatch takes: drivers reset a GPU that hangs, so none may run for seconds.
//!
//! Work is counted in samples along rays, which the host can estimate before a cast; what a sample costs is learnt
//! from the pieces before. A sample in the air costs one read, a visible and dearly shaded one hundreds, so a piece
//! is kept small enough for either.

use std::time::Duration;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::sample_count;
use wheatstone_core::view::{RayField, View};

/// What a dispatch should take if its samples cost what recent ones did.
const TYPICAL_SECONDS: f64 = 0.25;

/// What a dispatch may take if the recent samples were all in the air and its own are all visible.
const WORST_SECONDS: f64 = 2.0;

/// Cost of a sample before any is timed: that of software Vulkan on two cores.
const FIRST_SECONDS_PER_SAMPLE: f64 = 20e-9;

/// Dispatches below this duration tell nothing about the cost of a sample.
const SHORTEST_TIMED: Duration = Duration::from_millis(2);

/// Loop iterations that a shader may run per invocation: Mesa 22's software Vulkan silently stops at about
/// 65,000, summed over nested loops.
pub(crate) const ITERATION_LIMIT: u32 = 60_000;

/// Rays that software Vulkan casts in lockstep; each may wait for the others.
pub(crate) const LOCKSTEP_RAYS: u32 = 8;

/// Rows that a piece is a whole number of: the side of a workgroup, `BAND_ROWS` of `cast.wgsl`.
pub(crate) const BAND_ROWS: u32 = 8;

/// Rays of a band whose samples are counted.
const PROBES: u32 = 16;

/// Sizes pieces by what earlier ones took.
#[derive(Debug)]
pub(crate) struct Pacer {
    seconds_per_sample: f64,
}

impl Pacer {
    pub(crate) fn new() -> Self {
        Self { seconds_per_sample: FIRST_SECONDS_PER_SAMPLE }
    }

    /// Samples that the next piece may take, where a visible sample reads the volume up to `reads_per_sample` times.
    pub(crate) fn budget(&self, reads_per_sample: u32) -> f64 {
        let typical = TYPICAL_SECONDS / self.seconds_per_sample;
        let worst = WORST_SECONDS / (self.seconds_per_sample * f64::from(reads_per_sample));
        typical.min(worst)
    }

    /// Learns from a piece: dear ones at once, cheap ones gradually.
    pub(crate) fn learn(&mut self, samples: f64, elapsed: Duration) {
        let timed = if elapsed < SHORTEST_TIMED { 0.0 } else { elapsed.as_secs_f64() / samples };
        self.seconds_per_sample = timed.max(0.5 * self.seconds_per_sample).max(1e-15);
    }
}

/// What samples take before any is timed, seconds, where each may read the volume up to `reads_per_sample` times.
pub(crate) fn guessed_s(samples: f64, reads_per_sample: u32) -> f64 {
    samples * FIRST_SECONDS_PER_SAMPLE * f64::from(reads_per_sample)
}

/// Samples of each band of a picture, estimated from a few rays of its middle row; at least one per ray.
pub(crate) fn band_samples(parameters: &CastParameters, view: &View) -> Vec<f64> {
    let rays = RayField::new(view, parameters.texture_from_world);
    let [width, height] = view.size;
    let samples_of_band = |band: u32| {
        let first_row = band * BAND_ROWS;
        let rows = BAND_ROWS.min(height - first_row);
        let y = f64::from(first_row) + 0.5 * f64::from(rows);
        let probe = |i: u32| {
            let x = (f64::from(i) + 0.5) / f64::from(PROBES) * f64::from(width);
            f64::from(sample_count(&rays, parameters, x, y).max(1))
        };
        (0..PROBES).map(probe).sum::<f64>() / f64::from(PROBES) * f64::from(width) * f64::from(rows)
    };
    (0..height.div_ceil(BAND_ROWS)).map(samples_of_band).collect()
}

/// How many of the next bands fit a budget, at least one; and their samples.
pub(crate) fn fitting_bands(bands: &[f64], budget: f64) -> (u32, f64) {
    let (mut count, mut samples) = (0, 0.0);
    for &band in bands {
        if count > 0 && samples + band > budget {
            break;
        }
        count += 1;
        samples += band;
    }
    (count, samples)
}

/// A stride that spreads any run of a piece's bands over all of it: software Vulkan gives each thread a run of
/// workgroups, which would else be dear for one thread and cheap for another.
pub(crate) fn spreading_stride(bands: u32) -> u32 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let has_common_factor = |stride: &u32| {
        let (mut a, mut b) = (*stride, bands);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a != 1
    };
    let ideal = ((f64::from(bands) * GOLDEN) as u32).max(1);
    (ideal..=bands.max(ideal)).find(|stride| !has_common_factor(stride)).unwrap_or(1)
}

/// Samples that one dispatch takes of each ray; all of them (`u32::MAX`) where neither the drivers' limit on loop
/// iterations nor the budget asks for less.
pub(crate) fn sample_limit(most_samples: u32, iterations_per_sample: u32, share_of_ray: f64) -> u32 {
    let driver_limit = ITERATION_LIMIT / iterations_per_sample.max(1);
    let budget_limit = (f64::from(most_samples) * share_of_ray).ceil().max(16.0) as u32;
    let limit = driver_limit.min(budget_limit);
    if most_samples <= limit { u32::MAX } else { limit }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Casts bands with a pacer and returns the longest dispatch in seconds.
    fn longest_dispatch(bands: &[f64], reads: u32, seconds_per_sample: impl Fn(usize) -> f64) -> f64 {
        let mut pacer = Pacer::new();
        let (mut at, mut longest) = (0, 0.0_f64);
        while at < bands.len() {
            let (count, samples) = fitting_bands(&bands[at..], pacer.budget(reads));
            let seconds = samples * seconds_per_sample(at);
            pacer.learn(samples, Duration::from_secs_f64(seconds));
            longest = longest.max(seconds);
            at += count as usize;
        }
        longest
    }

    #[test]
    fn dispatches_stay_short_when_dense_rows_follow_empty_ones() {
        let mut bands = vec![6_000.0; 40];
        bands.extend(vec![1e6; 60]);
        let (air, reads) = (10e-9, 25);
        let cost = |band: usize| if band < 60 { air } else { air * f64::from(reads) };
        assert!(longest_dispatch(&bands, reads, cost) <= 2.5);
    }

    #[test]
    fn a_fast_device_comes_to_take_a_picture_in_one_go() {
        let mut pacer = Pacer::new();
        for _ in 0..20 {
            pacer.learn(1e7, Duration::from_micros(500));
        }
        assert!(pacer.budget(1) > 1e9);
    }

    #[test]
    fn at_least_one_band_is_taken() {
        assert_eq!(fitting_bands(&[5.0, 5.0, 5.0], 1.0), (1, 5.0));
        assert_eq!(fitting_bands(&[5.0, 5.0, 5.0], 12.0), (2, 10.0));
        assert_eq!(fitting_bands(&[5.0], 1e9), (1, 5.0));
    }

    #[test]
    fn a_spreading_stride_visits_every_band_once() {
        for bands in 1..300 {
            let stride = spreading_stride(bands);
            let mut visited: Vec<u32> = (0..bands).map(|i| i * stride % bands).collect();
            visited.sort_unstable();
            assert!(visited.into_iter().eq(0..bands), "{bands} {stride}");
        }
    }

    #[test]
    fn short_rays_are_cast_in_one_go() {
        assert_eq!(sample_limit(2000, 1, 1.0), u32::MAX);
        assert_eq!(sample_limit(2500, 25, 1.0), 2400);
        assert_eq!(sample_limit(2000, 1, 0.25), 500);
    }
}
