//! The baked transfer function that both casters look up.

use super::TransferFunction;

/// Colour and the base-2 logarithm of the transmittance of one voxel length: `[r, g, b, log2(1 − α)]`.
///
/// The logarithm makes the opacity of a step of Δ voxel lengths `1 − exp2(Δ · log2(1 − α))`: one `exp2`.
pub type LutEntry = [f32; 4];

/// The logarithm that stands for α = 1.
pub const OPAQUE_LOG2: f32 = -1000.0;

/// Entries of a one-dimensional table.
pub const LUT_1D_ENTRIES: usize = 4096;

const VALUES_2D: usize = 1024;
const GRADIENTS_2D: usize = 256;
const SEGMENT_ENDS: usize = 512;

/// A table over normalised value (fast axis) and a second coordinate.
///
/// Looked up by interpolating the logarithm between entries (an error of α would add up along a ray) and taking the
/// colour of the nearest entry (an 8192th of its change is invisible).
///
/// The second coordinate is nothing for 1D transfer functions (height 1), the gradient magnitude in [0, 1] for
/// 2D ones, and the value at the segment's far end for pre-integrated ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Lut {
    width: usize,
    height: usize,
    entries: Vec<LutEntry>,
    visible: (f32, f32),
}

impl Lut {
    /// Bakes a 1D or 2D transfer function.
    pub fn bake(transfer: &TransferFunction) -> Self {
        let (width, height) = if transfer.is_2d() { (VALUES_2D, GRADIENTS_2D) } else { (LUT_1D_ENTRIES, 1) };
        let gradient_alpha: Vec<f32> =
            (0..height).map(|row| transfer.gradient_opacity_at(coordinate(row, height))).collect();
        let columns: Vec<([f32; 3], f32)> = (0..width)
            .map(|column| coordinate(column, width))
            .map(|value| (transfer.color_at(value), transfer.opacity_at(value)))
            .collect();
        let entries = gradient_alpha
            .iter()
            .flat_map(|&factor| {
                columns.iter().map(move |&([r, g, b], alpha)| [r, g, b, log2_transmittance(alpha * factor)])
            })
            .collect();
        Self::from_entries(width, height, entries)
    }

    /// Bakes a transfer function with its gradient opacity left out.
    pub fn bake_by_value(transfer: &TransferFunction) -> Self {
        Self::bake(&TransferFunction { gradient_opacity: Vec::new(), ..transfer.clone() })
    }

    /// Bakes the pre-integrated form of a 1D transfer function (Engel, Kraus, Ertl 2001): entry (front, back)
    /// is the mean colour and transmittance of a voxel length along which the value goes linearly from front to
    /// back. A gradient opacity is left out.
    pub fn bake_preintegrated(transfer: &TransferFunction) -> Self {
        let fine = Self::bake_by_value(transfer);
        // Running integrals over value of extinction and of extinction-weighted colour.
        let mut integral = vec![[0.0_f64; 4]; fine.width + 1];
        for (i, &[r, g, b, log2]) in fine.entries.iter().enumerate() {
            let extinction = f64::from(-log2);
            let weighted = [f64::from(r), f64::from(g), f64::from(b), 1.0].map(|c| c * extinction);
            integral[i + 1] = [0, 1, 2, 3].map(|c| integral[i][c] + weighted[c]);
        }
        let fine_index =
            |end: usize| (coordinate(end, SEGMENT_ENDS) * (fine.width - 1) as f32 + 0.5) as usize;
        let entries = (0..SEGMENT_ENDS * SEGMENT_ENDS)
            .map(|i| {
                let (front, back) = (fine_index(i % SEGMENT_ENDS), fine_index(i / SEGMENT_ENDS));
                let (lo, hi) = (front.min(back), front.max(back) + 1);
                let sum = [0, 1, 2, 3].map(|c| integral[hi][c] - integral[lo][c]);
                let mean_extinction = sum[3] / (hi - lo) as f64;
                if mean_extinction <= 0.0 {
                    let [r, g, b, _] = fine.entries[front];
                    return [r, g, b, 0.0];
                }
                let rgb = [0, 1, 2].map(|c| (sum[c] / sum[3]) as f32);
                [rgb[0], rgb[1], rgb[2], (-mean_extinction as f32).max(OPAQUE_LOG2)]
            })
            .collect();
        Self::from_entries(SEGMENT_ENDS, SEGMENT_ENDS, entries)
    }

    fn from_entries(width: usize, height: usize, entries: Vec<LutEntry>) -> Self {
        let opaque_columns =
            || (0..width).filter(|&column| (0..height).any(|row| entries[row * width + column][3] < 0.0));
        let one_entry = 1.01 / (width - 1) as f32;
        let visible = match (opaque_columns().next(), opaque_columns().next_back()) {
            (Some(first), Some(last)) => {
                (coordinate(first, width) - one_entry, coordinate(last, width) + one_entry)
            }
            _ => (2.0, -1.0),
        };
        Self { width, height, entries, visible }
    }

    /// Entries along the value axis.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Entries along the second axis.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Entries, the value axis fastest.
    pub fn entries(&self) -> &[LutEntry] {
        &self.entries
    }

    /// Every value outside this closed interval is fully transparent. Empty (first above second) if nothing is
    /// visible.
    pub fn visible(&self) -> (f32, f32) {
        self.visible
    }

    /// The entry at a normalised value, for 1D tables.
    pub fn at(&self, value: f32) -> LutEntry {
        self.at_in_row(0, value)
    }

    /// The entry at a normalised value and a second coordinate in [0, 1].
    pub fn at_2d(&self, value: f32, second: f32) -> LutEntry {
        let (row, fraction) = position(second, self.height);
        let (below, above) = (self.at_in_row(row, value), self.at_in_row(row + 1, value));
        let [r, g, b, _] = if fraction < 0.5 { below } else { above };
        [r, g, b, below[3] + (above[3] - below[3]) * fraction]
    }

    fn at_in_row(&self, row: usize, value: f32) -> LutEntry {
        let (column, fraction) = position(value, self.width);
        let before = row * self.width + column;
        let (below, above) = (self.entries[before][3], self.entries[before + 1][3]);
        let [r, g, b, _] = self.entries[before + (fraction + 0.5) as usize];
        [r, g, b, below + (above - below) * fraction]
    }
}

/// The entry before a coordinate in [0, 1] that has one after it, and the way from it to that one.
fn position(coordinate: f32, count: usize) -> (usize, f32) {
    let along = coordinate * (count - 1) as f32;
    let before = (along as usize).min(count - 2);
    (before, along - before as f32)
}

fn coordinate(index: usize, count: usize) -> f32 {
    if count == 1 { 0.0 } else { index as f32 / (count - 1) as f32 }
}

fn log2_transmittance(alpha: f32) -> f32 {
    (1.0 - alpha.clamp(0.0, 1.0)).log2().max(OPAQUE_LOG2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramp_bakes_to_its_opacity() {
        let lut = Lut::bake(&TransferFunction::ramp(0.25, 0.75).unwrap());
        assert_eq!(lut.at(0.2)[3], 0.0);
        assert!((1.0 - lut.at(0.5)[3].exp2() - 0.5).abs() < 1e-3);
        assert_eq!(lut.at(1.0), [1.0, 1.0, 1.0, OPAQUE_LOG2]);
        assert!((0.249..0.2505).contains(&lut.visible().0));
        assert!(lut.visible().1 >= 1.0);
    }

    #[test]
    fn two_dimensional_ramp_needs_value_and_gradient() {
        let lut = Lut::bake(&TransferFunction::ramp_2d(0.0, 1.0, 0.1, 0.3).unwrap());
        assert_eq!(lut.at_2d(0.9, 0.05)[3], 0.0);
        assert!((1.0 - lut.at_2d(0.5, 0.2)[3].exp2() - 0.25).abs() < 0.01);
    }

    #[test]
    fn preintegrated_diagonal_is_the_function_itself() {
        let transfer = TransferFunction::ramp(0.2, 0.9).unwrap();
        let (lut, pre) = (Lut::bake(&transfer), Lut::bake_preintegrated(&transfer));
        for value in [0.1, 0.3, 0.5, 0.8] {
            assert!((pre.at_2d(value, value)[3] - lut.at(value)[3]).abs() < 0.02, "{value}");
        }
        let spike = pre.at_2d(0.0, 1.0);
        assert!(spike[3] < 0.0, "a segment that crosses visible values is visible");
        assert_eq!(pre.at_2d(0.0, 1.0), pre.at_2d(1.0, 0.0));
    }

    #[test]
    fn nothing_visible_gives_an_empty_interval() {
        let clear = TransferFunction::ramp(2.0, 3.0).unwrap();
        let (lo, hi) = Lut::bake(&clear).visible();
        assert!(lo > hi);
    }
}
