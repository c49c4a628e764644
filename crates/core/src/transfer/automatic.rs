//! A transfer function from the histogram, so that a first look at an unknown volume shows something.

use super::{ColorPoint, Colormap, OpacityPoint, TransferError, TransferFunction};
use crate::volume::Histogram;

/// Bins that [`automatic`] wants in its histogram.
pub const AUTOMATIC_BINS: usize = 256;

/// Optical depth (−ln of the transmittance) of a ray through the whole object: all but 0.25 % of the light is absorbed,
/// half of it in the first eighth.
const TARGET_DEPTH: f64 = 6.0;
/// The same for a volume of one value, which hides nothing: 63 % of the light is absorbed.
const CONSTANT_DEPTH: f64 = 1.0;
/// At most this many occupied bins make a label map.
const MOST_LABELS: usize = 16;
/// A bin below Otsu's threshold that holds this share of the tallest one there belongs to the background.
const TALL_PEAK: f64 = 0.25;
/// The background ends where the histogram has fallen to this share of its last tall peak.
const PEAK_END: f64 = 0.02;
/// A peak of at least this share of the voxels may be air above padding …
const AIR_SHARE: f64 = 0.2;
/// … if it covers at most one in so many bins.
const NARROWEST_TISSUE: usize = 16;
/// The position of full opacity: this share of the foreground lies below.
const TOP_QUANTILE: f64 = 0.999;
const KNOTS: usize = 24;
const HIGHEST_ALPHA: f64 = 0.95;

/// From the background's edge to the brightest values.
const WARM: [[f64; 3]; 5] =
    [[0.36, 0.08, 0.06], [0.70, 0.26, 0.13], [0.90, 0.54, 0.26], [0.97, 0.81, 0.55], [1.0, 0.98, 0.93]];

/// A transfer function for values that are normalised by the window that the histogram was counted over.
///
/// `dims` are the volume's voxels along each axis: longer rays get lower opacities. The document
/// `docs/transfer-functions.md` describes the method. The same histogram always gives the same function.
///
/// # Errors
/// [`TransferError::NoPoints`] for a histogram without bins.
pub fn automatic(histogram: &Histogram, dims: [usize; 3]) -> Result<TransferFunction, TransferError> {
    let counts = &histogram.counts;
    if counts.is_empty() {
        return Err(TransferError::NoPoints("histogram"));
    }
    let shares = shares(counts);
    let occupied: Vec<usize> = (0..counts.len()).filter(|&bin| counts[bin] > 0).collect();
    // The mean chord of a box is shorter than its sides; the geometric mean of these is near enough.
    let side_voxels = dims.iter().map(|&d| d.max(1) as f64).product::<f64>().cbrt();
    if occupied.len() < 2 {
        constant(side_voxels)
    } else if occupied.len() <= MOST_LABELS && occupied.len() * 4 <= counts.len() {
        labels(&shares, &occupied, side_voxels)
    } else {
        continuous(&shares, side_voxels)
    }
}

fn shares(counts: &[u64]) -> Vec<f64> {
    let total = counts.iter().sum::<u64>().max(1) as f64;
    counts.iter().map(|&count| count as f64 / total).collect()
}

/// Length of a ray through an object that fills a share of the volume, voxels.
fn thickness_voxels(share: f64, side_voxels: f64) -> f64 {
    (side_voxels * share.cbrt()).max(1.0)
}

/// The opacity of one voxel length of which `length_voxels` reach an optical depth.
fn alpha_over(length_voxels: f64, depth: f64) -> f64 {
    (1.0 - (-depth / length_voxels).exp()).min(HIGHEST_ALPHA)
}

fn constant(side_voxels: f64) -> Result<TransferFunction, TransferError> {
    let alpha = alpha_over(side_voxels, CONSTANT_DEPTH) as f32;
    TransferFunction::new(vec![ColorPoint { at: 0.0, rgb: [0.8; 3] }], vec![OpacityPoint { at: 0.0, alpha }])
}

/// Equal opacity and a colour of its own for every value but the lowest.
fn labels(shares: &[f64], occupied: &[usize], side_voxels: f64) -> Result<TransferFunction, TransferError> {
    let background = occupied[0];
    let alpha = alpha_over(thickness_voxels(1.0 - shares[background], side_voxels), TARGET_DEPTH) as f32;
    let centre = |bin: usize| ((bin as f64 + 0.5) / shares.len() as f64) as f32;
    let visible = &occupied[1..];
    let color = visible
        .iter()
        .enumerate()
        .map(|(rank, &bin)| {
            let position = (rank as f32 + 0.5) / visible.len() as f32;
            let rgb =
                if visible.len() == 1 { [0.93, 0.82, 0.68] } else { Colormap::Turbo.color_at(position) };
            ColorPoint { at: centre(bin), rgb }
        })
        .collect();
    let (from, to) = (centre(background), centre(visible[0]));
    let edge = |t: f32, alpha: f32| OpacityPoint { at: from + (to - from) * t, alpha };
    TransferFunction::new(color, vec![edge(0.25, 0.0), edge(0.75, alpha)])
}

fn continuous(shares: &[f64], side_voxels: f64) -> Result<TransferFunction, TransferError> {
    let bins = shares.len();
    let first = background_end(shares);
    let foreground: f64 = shares[first..].iter().sum();
    // Share of the foreground that lies below the middle of each bin.
    let mut below = 0.0;
    let ranks: Vec<f64> = (0..bins)
        .map(|bin| {
            let share = if bin < first { 0.0 } else { shares[bin] / foreground };
            below += share;
            below - 0.5 * share
        })
        .collect();
    let top = (first..bins).find(|&bin| ranks[bin] >= TOP_QUANTILE).unwrap_or(bins - 1).max(first + 1);
    let linear =
        |bin: usize| ((bin as f64 + 0.5 - first as f64) / (top as f64 + 0.5 - first as f64)).min(1.0);
    let shape = |bin: usize| linear(bin).sqrt() * ranks[bin];
    let length = thickness_voxels(foreground, side_voxels);
    let depth = |scale: f64| -> f64 {
        let mean_extinction: f64 = (first..bins)
            .map(|bin| shares[bin] / foreground * -(1.0 - (scale * shape(bin)).min(HIGHEST_ALPHA)).ln())
            .sum();
        length * mean_extinction
    };
    let scale = bisect(depth);
    let position = |bin: usize| ((bin as f64 + 0.5) / bins as f64) as f32;
    let edge = (first as f64 / bins as f64) as f32;
    let mut color = vec![ColorPoint { at: edge, rgb: warm(0.0) }];
    let mut opacity = vec![OpacityPoint { at: edge, alpha: 0.0 }];
    let mut previous = None;
    for knot in 0..KNOTS {
        let bin = first + (top - first) * knot / (KNOTS - 1);
        if previous != Some(bin) && bin < bins {
            let alpha = (scale * shape(bin)).min(HIGHEST_ALPHA) as f32;
            opacity.push(OpacityPoint { at: position(bin), alpha });
            color.push(ColorPoint { at: position(bin), rgb: warm(0.5 * (linear(bin) + ranks[bin])) });
        }
        previous = Some(bin);
    }
    TransferFunction::new(color, opacity)
}

/// The first bin above the background. Values that pad the corners of a scan lie apart below its air: where a gap
/// follows the lowest peak and then a narrow peak of many voxels, both are background.
fn background_end(shares: &[f64]) -> usize {
    let highest = shares.iter().rposition(|&share| share > 0.0).unwrap_or(0);
    let end = peak_end(shares);
    let after_gap = (end..shares.len()).find(|&bin| shares[bin] > 0.0).unwrap_or(highest);
    if after_gap > end {
        let air_end = after_gap + peak_end(&shares[after_gap..]);
        let is_narrow = air_end - after_gap <= shares.len() / NARROWEST_TISSUE;
        if is_narrow && shares[after_gap..air_end].iter().sum::<f64>() >= AIR_SHARE {
            return air_end.min(highest);
        }
    }
    // Something must be left to show.
    end.min(highest)
}

/// The first bin above the last tall peak in the lower class of values.
fn peak_end(shares: &[f64]) -> usize {
    let threshold = otsu(shares);
    let tallest = shares[..=threshold].iter().copied().fold(0.0, f64::max);
    let peak = (0..=threshold).rfind(|&bin| shares[bin] >= TALL_PEAK * tallest).unwrap_or(0);
    (peak + 1..=threshold).find(|&bin| shares[bin] <= PEAK_END * shares[peak]).unwrap_or(threshold + 1)
}

/// The last bin of the lower of the two classes that differ most (Otsu 1979).
fn otsu(shares: &[f64]) -> usize {
    let mean_total: f64 = shares.iter().enumerate().map(|(bin, share)| bin as f64 * share).sum();
    let (mut weight, mut mean_sum) = (0.0, 0.0);
    let mut best = (0, 0.0);
    for (bin, share) in shares[..shares.len() - 1].iter().enumerate() {
        weight += share;
        mean_sum += bin as f64 * share;
        let spread = mean_total * weight - mean_sum;
        let between =
            if weight > 0.0 && weight < 1.0 { spread * spread / (weight * (1.0 - weight)) } else { 0.0 };
        if between > best.1 {
            best = (bin, between);
        }
    }
    best.0
}

/// The scale at which the optical depth reaches its target, or the largest one if it never does.
fn bisect(depth: impl Fn(f64) -> f64) -> f64 {
    let (mut lo, mut hi) = (0.0, 64.0);
    for _ in 0..40 {
        let middle = 0.5 * (lo + hi);
        if depth(middle) < TARGET_DEPTH { lo = middle } else { hi = middle }
    }
    hi
}

fn warm(position: f64) -> [f32; 3] {
    let scaled = position.clamp(0.0, 1.0) * (WARM.len() - 1) as f64;
    let below = (scaled as usize).min(WARM.len() - 2);
    let t = scaled - below as f64;
    [0, 1, 2].map(|c| (WARM[below][c] + (WARM[below + 1][c] - WARM[below][c]) * t) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const DIMS: [usize; 3] = [256; 3];

    fn of(counts: Vec<u64>) -> TransferFunction {
        automatic(&Histogram { counts }, DIMS).unwrap()
    }

    /// A bell of `voxels` around a bin.
    fn bell(counts: &mut [u64], centre: f64, width: f64, voxels: f64) {
        for (bin, count) in counts.iter_mut().enumerate() {
            let d = (bin as f64 - centre) / width;
            *count += (voxels * (-0.5 * d * d).exp() / (width * 2.5066)) as u64;
        }
    }

    #[test]
    fn air_is_clear_and_bone_is_denser_than_flesh() {
        let mut counts = vec![0; 256];
        bell(&mut counts, 2.0, 1.5, 6e5);
        bell(&mut counts, 70.0, 4.0, 3e5);
        bell(&mut counts, 130.0, 15.0, 3e4);
        let transfer = of(counts);
        assert_eq!(transfer.opacity_at(2.0 / 256.0), 0.0);
        assert_eq!(transfer.opacity_at(4.0 / 256.0), 0.0);
        let (flesh, bone) = (transfer.opacity_at(70.0 / 256.0), transfer.opacity_at(150.0 / 256.0));
        assert!(flesh > 0.001 && bone > 2.0 * flesh, "{flesh} {bone}");
        assert!(bone > 0.02, "{bone}");
        let brightness = |v: f32| transfer.color_at(v).iter().sum::<f32>();
        assert!(brightness(150.0 / 256.0) > brightness(60.0 / 256.0));
    }

    #[test]
    fn padding_below_air_is_background_too() {
        let mut counts = vec![0; 256];
        counts[0] = 200_000;
        bell(&mut counts, 80.0, 2.0, 4e5);
        bell(&mut counts, 145.0, 5.0, 3e5);
        let transfer = of(counts);
        assert_eq!(transfer.opacity_at(0.0), 0.0);
        assert_eq!(transfer.opacity_at(82.0 / 256.0), 0.0);
        assert!(transfer.opacity_at(150.0 / 256.0) > 0.005);
    }

    #[test]
    fn larger_volumes_get_lower_opacities() {
        let mut counts = vec![0; 256];
        bell(&mut counts, 0.0, 2.0, 5e5);
        bell(&mut counts, 120.0, 30.0, 3e5);
        let histogram = Histogram { counts };
        let at = |size: usize| automatic(&histogram, [size; 3]).unwrap().opacity_at(0.6);
        assert!(at(32) > 1.5 * at(128) && at(128) > 1.5 * at(512));
    }

    #[test]
    fn masks_and_labels_are_visible_and_their_background_is_not() {
        let mut mask = vec![0; 256];
        (mask[0], mask[255]) = (900_000, 100_000);
        let transfer = of(mask);
        assert_eq!(transfer.opacity_at(0.0), 0.0);
        assert!(transfer.opacity_at(1.0) > 0.02);
        let mut labels = vec![0; 256];
        for label in 0..5 {
            labels[label * 63] = 10_000;
        }
        let transfer = of(labels);
        assert_eq!(transfer.opacity_at(0.0), 0.0);
        let alphas: Vec<f32> = (1..5).map(|label| transfer.opacity_at(label as f32 * 63.5 / 256.0)).collect();
        assert!(alphas.iter().all(|&alpha| alpha == alphas[0] && alpha > 0.01), "{alphas:?}");
        assert_ne!(transfer.color_at(63.5 / 256.0), transfer.color_at(126.5 / 256.0));
    }

    #[test]
    fn one_value_is_a_faint_block() {
        let mut counts = vec![0; 256];
        counts[0] = 1000;
        let alpha = of(counts).opacity_at(0.0);
        assert!((0.001..0.1).contains(&alpha), "{alpha}");
        assert!(automatic(&Histogram { counts: vec![] }, DIMS).is_err());
    }

    proptest! {
        #[test]
        fn any_histogram_gives_a_visible_function(
            counts in prop::collection::vec(prop_oneof![Just(0_u64), 0..100_u64, 0..1_000_000_u64], 1..300),
            dims in prop::array::uniform3(0_usize..2000),
        ) {
            let histogram = Histogram { counts };
            let transfer = automatic(&histogram, dims).unwrap();
            prop_assert!((0..=512).any(|i| transfer.opacity_at(i as f32 / 512.0) > 0.0));
            prop_assert_eq!(automatic(&histogram, dims).unwrap(), transfer);
        }
    }
}
