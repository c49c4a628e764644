//! An observer that sees depth by comparing what two eyes, or one that has moved, see (LF §6).

use crate::image::RgbImage;
use crate::metrics::SizeMismatch;

/// Matches blocks of one picture with another along rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observer {
    /// Side of a block, pixels.
    pub block_px: u32,
    /// Furthest that a block is sought to either side, pixels.
    pub reach_px: u32,
}

/// Share of a field's disparities that is taken to be mistaken at either end.
const MISTAKEN: f64 = 0.1;

/// Least range of brightness in a block that can be recognised.
const LEAST_CONTRAST: f32 = 0.1;

impl Observer {
    /// How far blocks of the left picture are to the left in the right one, pixels: positive for what is in front of the screen. Blocks
    /// begin at every other pixel; those without contrast are left out.
    ///
    /// # Errors
    /// Pictures of different sizes.
    pub fn disparities_px(&self, left: &RgbImage, right: &RgbImage) -> Result<Vec<i32>, SizeMismatch> {
        let (first, second) = ([left.width, left.height], [right.width, right.height]);
        if first != second {
            return Err(SizeMismatch { first, second });
        }
        let [left, right] = [left, right].map(brightness);
        let last = |side: u32| side.saturating_sub(self.block_px);
        let places = |side: u32| (0..=last(side)).step_by(2).filter(move |_| side >= self.block_px);
        let mut found = Vec::new();
        for top in places(first[1]) {
            for column in places(first[0]) {
                let rows = || (top..top + self.block_px).map(|y| (y * first[0]) as usize);
                let block = |levels: &'_ [f32], start: usize| -> Vec<f32> {
                    rows()
                        .flat_map(|row| levels[row + start..row + start + self.block_px as usize].to_vec())
                        .collect()
                };
                let wanted = block(&left, column as usize);
                let (low, high) =
                    wanted.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
                if high - low < LEAST_CONTRAST {
                    continue;
                }
                let difference = |shift: i32| {
                    let start = usize::try_from(i64::from(column) - i64::from(shift)).ok()?;
                    let is_within = start + self.block_px as usize <= first[0] as usize;
                    is_within.then(|| {
                        let other = block(&right, start);
                        wanted.iter().zip(&other).map(|(a, b)| (a - b).abs()).sum::<f32>()
                    })
                };
                let reach = self.reach_px as i32;
                // Of equals the nearest to none.
                let mut shifts: Vec<i32> = (-reach..=reach).collect();
                shifts.sort_by_key(|shift| shift.abs());
                let sums = shifts.into_iter().filter_map(|shift| Some((shift, difference(shift)?)));
                found.extend(sums.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(shift, _)| shift));
            }
        }
        Ok(found)
    }

    /// How deep a scene looks: from the furthest to the nearest disparity, pixels, mistaken ones left out; 0 if there is nothing to
    /// compare.
    ///
    /// # Errors
    /// Pictures of different sizes.
    pub fn depth_px(&self, left: &RgbImage, right: &RgbImage) -> Result<i32, SizeMismatch> {
        let mut disparities = self.disparities_px(left, right)?;
        disparities.sort_unstable();
        let Some(last) = disparities.len().checked_sub(1) else { return Ok(0) };
        let at = |share: f64| disparities[(share * last as f64).round() as usize];
        Ok(at(1.0 - MISTAKEN) - at(MISTAKEN))
    }
}

fn brightness(picture: &RgbImage) -> Vec<f32> {
    picture.rgb.iter().map(|[r, g, b]| (r + g + b) / 3.0).collect()
}
