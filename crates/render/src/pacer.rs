//! How much of a picture one dispatch takes: drivers reset a GPU that hangs, so none may run for seconds.

use std::time::Duration;

/// What a dispatch should take at most.
const LONGEST: Duration = Duration::from_millis(250);

/// Loop iterations that a shader may run per invocation: Mesa 22's software Vulkan silently stops at about
/// 65,000, summed over nested loops.
const ITERATION_LIMIT: u32 = 60_000;

/// Pixels of the very first dispatch of a renderer.
const FIRST_PIXELS: f64 = 65_536.0;

/// Sizes pieces by what earlier ones took.
#[derive(Debug)]
pub(crate) struct Pacer {
    pixels: f64,
}

impl Pacer {
    pub(crate) fn new() -> Self {
        Self { pixels: FIRST_PIXELS }
    }

    /// Rows of the next piece: a whole number of workgroups.
    pub(crate) fn rows(&self, width: u32, rows_left: u32) -> u32 {
        let rows = (self.pixels / f64::from(width)) as u32;
        (rows / 8 * 8).clamp(8, rows_left.max(8)).min(rows_left)
    }

    /// Learns from a piece. Growth and shrinkage are bounded, so one odd timing does little harm.
    pub(crate) fn learn(&mut self, pixels: u32, elapsed: Duration) {
        let per_pixel = elapsed.as_secs_f64() / f64::from(pixels.max(1));
        let ideal = LONGEST.as_secs_f64() / per_pixel.max(1e-12);
        self.pixels = ideal.clamp(self.pixels * 0.25, self.pixels * 4.0).clamp(64.0, 1e9);
    }
}

/// Samples that one dispatch takes of each ray, given the loop iterations that a sample costs; all of them
/// (`u32::MAX`) where the longest ray stays below the limit.
pub(crate) fn sample_limit(most_samples: u32, iterations_per_sample: u32) -> u32 {
    let limit = ITERATION_LIMIT / iterations_per_sample.max(1);
    if most_samples <= limit { u32::MAX } else { limit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_approach_the_longest_time_and_cover_the_rows() {
        let mut pacer = Pacer::new();
        for _ in 0..20 {
            let rows = pacer.rows(1000, 1 << 20);
            pacer.learn(rows * 1000, Duration::from_micros(u64::from(rows) * 1000));
        }
        assert!((240..=250).contains(&pacer.rows(1000, 1 << 20)), "{}", pacer.rows(1000, 1 << 20));
        assert_eq!(pacer.rows(1000, 3), 3);
        pacer.learn(1, Duration::from_secs(1000));
        assert!(pacer.rows(1 << 14, 100) == 8);
    }

    #[test]
    fn short_rays_are_cast_in_one_go() {
        assert_eq!(sample_limit(2000, 1), u32::MAX);
        assert_eq!(sample_limit(2000, 25), u32::MAX);
        assert_eq!(sample_limit(2500, 25), 2400);
    }
}
