//! How coarse a view is.

/// Coarsest level: a quarter of the pixels along each side, steps four times as long.
const COARSEST: u32 = 6;

/// A step of a ladder: each level takes about half the work of the one before, a third of the saving from each picture axis and
/// a third from the steps along rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Quality {
    level: u32,
}

impl Quality {
    /// Every pixel, every sample.
    pub const FULL: Self = Self { level: 0 };

    /// 1/64 of the work.
    pub const COARSEST: Self = Self { level: COARSEST };

    /// 0 is full quality; levels beyond the coarsest are the coarsest.
    pub fn at(level: u32) -> Self {
        Self { level: level.min(COARSEST) }
    }

    /// 0 is full quality, each level above takes half the work.
    pub fn level(self) -> u32 {
        self.level
    }

    /// Pixels along a side of the picture as a share of full quality's.
    pub fn resolution(self) -> f64 {
        (-f64::from(self.level) / 3.0).exp2()
    }

    /// Length of steps along rays as a multiple of full quality's.
    pub fn step_factor(self) -> f64 {
        (f64::from(self.level) / 3.0).exp2()
    }

    /// Samples per pixel as a share of full quality's.
    pub fn work_per_pixel(self) -> f64 {
        self.step_factor().recip()
    }

    /// A picture's width and height in pixels at this quality; at least one pixel each, unless there are none.
    pub fn size(self, full_size: [u32; 2]) -> [u32; 2] {
        full_size.map(|side| ((f64::from(side) * self.resolution()).round() as u32).max(side.min(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_level_halves_the_work() {
        for level in 0..=COARSEST {
            let quality = Quality::at(level);
            let work = quality.resolution().powi(2) * quality.work_per_pixel();
            assert!((work - 0.5_f64.powi(level as i32)).abs() < 1e-12);
        }
        assert_eq!(Quality::at(u32::MAX), Quality::COARSEST);
    }

    #[test]
    fn pictures_shrink_to_a_quarter_and_not_to_nothing() {
        assert_eq!(Quality::FULL.size([769, 2]), [769, 2]);
        assert_eq!(Quality::COARSEST.size([768, 1]), [192, 1]);
        assert_eq!(Quality::COARSEST.size([0, u32::MAX]), [0, 1 << 30]);
    }
}
