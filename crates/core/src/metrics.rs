//! How far two pictures are apart: SSIM, DSSIM, PSNR and the largest difference.

use crate::image::RgbImage;
use rayon::prelude::*;
use thiserror::Error;

/// Side of the square SSIM window, pixels.
pub const SSIM_WINDOW: usize = 8;

/// `(K1·L)²` of Wang et al. 2004 with K1 = 0.01 and dynamic range L = 1.
const C1: f64 = 0.01 * 0.01;
/// `(K2·L)²` of Wang et al. 2004 with K2 = 0.03 and dynamic range L = 1.
const C2: f64 = 0.03 * 0.03;

/// What a comparison of two pictures found. All values are of display-referred channels in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Structural similarity (Wang et al. 2004) with uniform 8×8 windows at every position, averaged over windows
    /// and channels; 1 for identical pictures.
    pub ssim: f64,
    /// Peak signal-to-noise ratio over all channels, dB; infinite for identical pictures.
    pub psnr_db: f64,
    /// Largest absolute difference of a channel.
    pub max_abs: f64,
}

impl Comparison {
    /// Structural dissimilarity `(1 − SSIM) / 2`.
    pub fn dssim(&self) -> f64 {
        dssim(self.ssim)
    }
}

/// Structural dissimilarity `(1 − SSIM) / 2`.
pub fn dssim(ssim: f64) -> f64 {
    0.5 * (1.0 - ssim)
}

/// Pictures (or a mask) that cannot be compared because their sizes differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("pictures of {}×{} and {}×{} pixels cannot be compared: one size is needed", first[0], first[1], second[0], second[1])]
pub struct SizeMismatch {
    /// Width and height of the first picture, pixels.
    pub first: [u32; 2],
    /// Width and height of the second picture, pixels; a mask of `n` pixels counts as `n`×1.
    pub second: [u32; 2],
}

/// Compares two pictures of one size. An axis shorter than the SSIM window gets one window of its whole length.
/// Empty pictures are identical.
///
/// # Errors
/// [`SizeMismatch`] if the sizes differ.
pub fn compare(first: &RgbImage, second: &RgbImage) -> Result<Comparison, SizeMismatch> {
    check_sizes(first, second)?;
    Ok(compare_sized(first, second, None))
}

/// Compares two pictures where a mask holds: SSIM over the windows that touch a marked pixel, PSNR and the largest
/// difference over the marked pixels. Pictures without a marked pixel are identical.
///
/// # Errors
/// [`SizeMismatch`] if the sizes differ or the mask does not hold one entry per pixel.
pub fn compare_where(
    first: &RgbImage,
    second: &RgbImage,
    marked: &[bool],
) -> Result<Comparison, SizeMismatch> {
    check_sizes(first, second)?;
    check_mask(size(first), marked)?;
    Ok(compare_sized(first, second, Some(marked)))
}

fn size(image: &RgbImage) -> [u32; 2] {
    [image.width, image.height]
}

fn check_sizes(first: &RgbImage, second: &RgbImage) -> Result<(), SizeMismatch> {
    if size(first) == size(second) {
        Ok(())
    } else {
        Err(SizeMismatch { first: size(first), second: size(second) })
    }
}

fn check_mask([width, height]: [u32; 2], marked: &[bool]) -> Result<(), SizeMismatch> {
    if marked.len() == width as usize * height as usize {
        return Ok(());
    }
    let length = u32::try_from(marked.len()).unwrap_or(u32::MAX);
    Err(SizeMismatch { first: [width, height], second: [length, 1] })
}

fn compare_sized(first: &RgbImage, second: &RgbImage, marked: Option<&[bool]>) -> Comparison {
    let (mut square_sum, mut count, mut max_abs) = (0.0_f64, 0_u64, 0.0_f64);
    for (i, (a, b)) in first.rgb.iter().zip(&second.rgb).enumerate() {
        if marked.is_none_or(|marked| marked[i]) {
            for c in 0..3 {
                let difference = (f64::from(a[c]) - f64::from(b[c])).abs();
                square_sum += difference * difference;
                max_abs = max_abs.max(difference);
            }
            count += 3;
        }
    }
    let mean_square = square_sum / count.max(1) as f64;
    let map = SsimMap::of_one_size(first, second);
    let ssim = marked.map_or_else(|| map.mean(), |marked| map.mean_of_marked(marked));
    Comparison { ssim, psnr_db: -10.0 * mean_square.log10(), max_abs }
}

/// SSIM of every window of two pictures, averaged over channels.
#[derive(Debug, Clone, PartialEq)]
pub struct SsimMap {
    /// Width and height of the pictures, pixels.
    size: [usize; 2],
    /// Width and height of a window, pixels.
    window: [usize; 2],
    /// One per position of a window, row by row from the top left.
    ssim: Vec<f64>,
}

impl SsimMap {
    /// Compares two pictures of one size window by window. An axis shorter than the SSIM window gets one window of its
    /// whole length.
    ///
    /// # Errors
    /// [`SizeMismatch`] if the sizes differ.
    pub fn new(first: &RgbImage, second: &RgbImage) -> Result<Self, SizeMismatch> {
        check_sizes(first, second)?;
        Ok(Self::of_one_size(first, second))
    }

    fn of_one_size(first: &RgbImage, second: &RgbImage) -> Self {
        let size = size(first).map(|side| side as usize);
        let window = size.map(|side| side.min(SSIM_WINDOW));
        if size.contains(&0) {
            return Self { size, window, ssim: Vec::new() };
        }
        let pixels = (window[0] * window[1]) as f64;
        let ssim = (0..=size[1] - window[1])
            .into_par_iter()
            .flat_map_iter(|top| {
                let columns = prefix_sums(first, second, top..top + window[1]);
                let of_window =
                    move |left: usize| window_ssim(&columns[left], &columns[left + window[0]], pixels);
                (0..=size[0] - window[0]).map(of_window)
            })
            .collect();
        Self { size, window, ssim }
    }

    /// Mean over all windows; 1 of none.
    pub fn mean(&self) -> f64 {
        mean(self.ssim.iter().copied())
    }

    /// Mean over the windows that touch a marked pixel; 1 of none.
    ///
    /// # Errors
    /// [`SizeMismatch`] if the mask does not hold one entry per pixel.
    pub fn mean_where(&self, marked: &[bool]) -> Result<f64, SizeMismatch> {
        check_mask(self.size.map(|side| side as u32), marked)?;
        Ok(self.mean_of_marked(marked))
    }

    fn mean_of_marked(&self, marked: &[bool]) -> f64 {
        if self.ssim.is_empty() {
            return 1.0;
        }
        let per_row = self.size[0] - self.window[0] + 1;
        mean(self.ssim.chunks(per_row).enumerate().flat_map(|(top, row)| {
            let marks = prefix_marks(marked, self.size[0], top..top + self.window[1]);
            row.iter()
                .enumerate()
                .filter(move |&(left, _)| marks[left + self.window[0]] > marks[left])
                .map(|(_, &ssim)| ssim)
        }))
    }

    /// For each pixel that of the window around it; near an edge that of the last window.
    pub fn around_pixels(&self) -> Vec<f64> {
        let [width, height] = self.size;
        let per_row = width - self.window[0] + 1;
        let begin = |at: usize, axis: usize| {
            at.saturating_sub(self.window[axis] / 2).min(self.size[axis] - self.window[axis])
        };
        (0..height)
            .flat_map(|y| (0..width).map(move |x| self.ssim[begin(y, 1) * per_row + begin(x, 0)]))
            .collect()
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u64), |(sum, count), value| (sum + value, count + 1));
    if count == 0 { 1.0 } else { sum / count as f64 }
}

/// Sums over a window or a column of it: Σx, Σy, Σx², Σy², Σxy for each of three channels.
type Moments = [[f64; 5]; 3];

/// Entry `x` holds the moments of all pixels of the rows that lie left of column `x`.
fn prefix_sums(first: &RgbImage, second: &RgbImage, rows: std::ops::Range<usize>) -> Vec<Moments> {
    let width = first.width as usize;
    let mut prefix = vec![[[0.0; 5]; 3]; width + 1];
    for y in rows {
        let pixels = y * width..(y + 1) * width;
        for (x, (a, b)) in first.rgb[pixels.clone()].iter().zip(&second.rgb[pixels]).enumerate() {
            for c in 0..3 {
                let (a, b) = (f64::from(a[c]), f64::from(b[c]));
                let sums = &mut prefix[x + 1][c];
                for (sum, term) in sums.iter_mut().zip([a, b, a * a, b * b, a * b]) {
                    *sum += term;
                }
            }
        }
    }
    for x in 0..width {
        let left = prefix[x];
        for (sums, before) in prefix[x + 1].iter_mut().zip(left) {
            for (sum, before) in sums.iter_mut().zip(before) {
                *sum += before;
            }
        }
    }
    prefix
}

fn prefix_marks(marked: &[bool], width: usize, rows: std::ops::Range<usize>) -> Vec<u64> {
    let mut prefix = vec![0_u64; width + 1];
    for x in 0..width {
        prefix[x + 1] = prefix[x] + rows.clone().map(|y| u64::from(marked[y * width + x])).sum::<u64>();
    }
    prefix
}

/// SSIM of one window, averaged over channels, from the prefix sums at its two sides.
fn window_ssim(left: &Moments, right: &Moments, pixels: f64) -> f64 {
    let channel = |c: usize| {
        let [mean_x, mean_y, xx, yy, xy] = [0, 1, 2, 3, 4].map(|m| (right[c][m] - left[c][m]) / pixels);
        let variance_sum = (xx - mean_x * mean_x).max(0.0) + (yy - mean_y * mean_y).max(0.0);
        let covariance = xy - mean_x * mean_y;
        (2.0 * mean_x * mean_y + C1) * (2.0 * covariance + C2)
            / ((mean_x * mean_x + mean_y * mean_y + C1) * (variance_sum + C2))
    };
    (channel(0) + channel(1) + channel(2)) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn constant(width: u32, height: u32, level: f32) -> RgbImage {
        RgbImage { width, height, rgb: vec![[level; 3]; (width * height) as usize] }
    }

    /// Wang et al.'s definition, window by window, two passes each.
    fn naive_ssim(a: &RgbImage, b: &RgbImage, marked: Option<&[bool]>) -> f64 {
        let (width, height) = (a.width as usize, a.height as usize);
        let (ww, wh) = (width.min(8), height.min(8));
        let mut values = Vec::new();
        for top in 0..=height - wh {
            for left in 0..=width - ww {
                let pixels: Vec<usize> =
                    (top..top + wh).flat_map(|y| (left..left + ww).map(move |x| y * width + x)).collect();
                if marked.is_some_and(|marked| !pixels.iter().any(|&i| marked[i])) {
                    continue;
                }
                for c in 0..3 {
                    let n = pixels.len() as f64;
                    let mean = |image: &RgbImage| {
                        pixels.iter().map(|&i| f64::from(image.rgb[i][c])).sum::<f64>() / n
                    };
                    let (mx, my) = (mean(a), mean(b));
                    let (mut vx, mut vy, mut cov) = (0.0, 0.0, 0.0);
                    for &i in &pixels {
                        let (dx, dy) = (f64::from(a.rgb[i][c]) - mx, f64::from(b.rgb[i][c]) - my);
                        vx += dx * dx / n;
                        vy += dy * dy / n;
                        cov += dx * dy / n;
                    }
                    values.push(
                        (2.0 * mx * my + 0.0001) * (2.0 * cov + 0.0009)
                            / ((mx * mx + my * my + 0.0001) * (vx + vy + 0.0009)),
                    );
                }
            }
        }
        if values.is_empty() { 1.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
    }

    fn image_pair() -> impl Strategy<Value = (RgbImage, RgbImage, Vec<bool>)> {
        (1_u32..20, 1_u32..20).prop_flat_map(|(width, height)| {
            let count = (width * height) as usize;
            let pixels = || prop::collection::vec(prop::array::uniform3(0.0_f32..=1.0), count);
            (pixels(), pixels(), prop::collection::vec(prop::bool::weighted(0.02), count)).prop_map(
                move |(a, b, marked)| {
                    (RgbImage { width, height, rgb: a }, RgbImage { width, height, rgb: b }, marked)
                },
            )
        })
    }

    proptest! {
        #[test]
        fn equals_the_definition((a, b, marked) in image_pair()) {
            let found = compare(&a, &b).unwrap();
            prop_assert!((found.ssim - naive_ssim(&a, &b, None)).abs() < 1e-9);
            let found = compare_where(&a, &b, &marked).unwrap();
            prop_assert!((found.ssim - naive_ssim(&a, &b, Some(&marked))).abs() < 1e-9);
        }

        #[test]
        fn identical_pictures_are_identical((a, _, _) in image_pair()) {
            let found = compare(&a, &a).unwrap();
            prop_assert!((found.ssim - 1.0).abs() < 1e-12);
            prop_assert!(found.dssim().abs() < 1e-12);
            prop_assert_eq!(found.psnr_db, f64::INFINITY);
            prop_assert_eq!(found.max_abs, 0.0);
        }
    }

    #[test]
    fn constant_pictures_leave_only_luminance() {
        let found = compare(&constant(16, 9, 0.5), &constant(16, 9, 0.75)).unwrap();
        let expected = (2.0 * 0.5 * 0.75 + 1e-4) / (0.25 + 0.5625 + 1e-4);
        assert!((found.ssim - expected).abs() < 1e-12);
        assert!((found.psnr_db - 20.0 * 4.0_f64.log10()).abs() < 1e-9);
        assert_eq!(found.max_abs, 0.25);
    }

    #[test]
    fn black_and_white_are_as_dissimilar_as_constants_get() {
        let found = compare(&constant(8, 8, 0.0), &constant(8, 8, 1.0)).unwrap();
        assert!((found.ssim - 1e-4 / (1.0 + 1e-4)).abs() < 1e-12);
        assert_eq!(found.psnr_db, 0.0);
    }

    #[test]
    fn a_mask_leaves_the_rest_out() {
        let a = constant(32, 8, 0.2);
        let mut b = a.clone();
        b.rgb[31] = [0.9; 3];
        let mut marked = vec![false; 32 * 8];
        marked[0] = true;
        let far = compare_where(&a, &b, &marked).unwrap();
        assert_eq!((far.ssim, far.max_abs), (1.0, 0.0));
        marked[31] = true;
        let near = compare_where(&a, &b, &marked).unwrap();
        assert!(near.ssim < 0.999 && near.max_abs > 0.69);
    }

    #[test]
    fn a_map_tells_where_pictures_differ() {
        let a = constant(24, 16, 0.2);
        let mut b = a.clone();
        b.rgb[4 * 24 + 4] = [0.9; 3];
        let map = SsimMap::new(&a, &b).unwrap();
        assert_eq!(map.mean(), compare(&a, &b).unwrap().ssim);
        let around = map.around_pixels();
        assert_eq!(around.len(), 24 * 16);
        for (i, &ssim) in around.iter().enumerate() {
            let is_near = i % 24 <= 8 && i / 24 <= 8;
            assert_eq!(ssim < 1.0 - 1e-9, is_near, "{} {}", i % 24, i / 24);
        }
        let mut marked = vec![false; 24 * 16];
        assert_eq!(map.mean_where(&marked), Ok(1.0));
        marked[4 * 24 + 4] = true;
        let covered = map.mean_where(&marked).unwrap();
        assert_eq!(covered, compare_where(&a, &b, &marked).unwrap().ssim);
        assert!(covered < map.mean());
        assert!(SsimMap::new(&constant(0, 5, 0.0), &constant(0, 5, 0.0)).unwrap().around_pixels().is_empty());
    }

    #[test]
    fn sizes_must_agree() {
        let error = compare(&constant(3, 4, 0.0), &constant(4, 3, 0.0)).unwrap_err();
        assert_eq!(error, SizeMismatch { first: [3, 4], second: [4, 3] });
        assert!(compare_where(&constant(3, 4, 0.0), &constant(3, 4, 0.0), &[true]).is_err());
        assert!(SsimMap::new(&constant(3, 4, 0.0), &constant(4, 3, 0.0)).is_err());
        assert!(
            SsimMap::new(&constant(3, 4, 0.0), &constant(3, 4, 0.0)).unwrap().mean_where(&[true]).is_err()
        );
        assert_eq!(compare(&constant(0, 5, 0.0), &constant(0, 5, 0.0)).unwrap().ssim, 1.0);
    }
}
