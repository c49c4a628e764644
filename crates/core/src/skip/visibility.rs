//! Which intervals of values can contribute to a picture.

use super::RangeCodes;
use crate::cast::{CastParameters, Classifier};
use crate::scene::Mode;
use crate::transfer::Lut;

/// What the second axis of a table of visible entries is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SecondAxis {
    /// Nothing: one row.
    None,
    /// The value again: the table is asked with the same interval on both axes.
    Value,
    /// The gradient magnitude.
    Gradient,
}

/// Whether a sample can contribute, as a summed-area table (Crow 1984) over the entries of a table of samples. Made once
/// per change of the settings.
///
/// The entries are those of the baked transfer function, or two classes of values on either side of a threshold:
///
/// | mode | entries | second axis | visible |
/// |---|---|---|---|
/// | composite, by value | table | none | transmittance < 1 |
/// | composite, by value and gradient | table | gradient | transmittance < 1 |
/// | composite, pre-integrated | table | value | transmittance < 1 |
/// | isosurface | < isovalue, ≥ isovalue | value | one of each |
/// | mean, X-ray, maximum | 0, > 0 | none | > 0 |
/// | minimum | < 1, 1 | none | < 1 |
#[derive(Debug, Clone, PartialEq)]
pub struct Visibility {
    value_axis: ValueAxis,
    second_axis: SecondAxis,
    size: [usize; 2],
    sums: Vec<u32>,
}

/// How normalised values fall on the entries of the first axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ValueAxis {
    /// Between the two entries on either side of `value · (count − 1)`, as [`Lut`] interpolates.
    Table,
    /// Entry 1 from a threshold upwards, entry 0 below.
    AtLeast(f32),
}

impl Visibility {
    /// The table of a cast.
    pub fn new(parameters: &CastParameters) -> Self {
        const ABOVE_ZERO: f32 = f32::from_bits(1);
        match (parameters.mode, parameters.classifier) {
            (Mode::Isosurface { .. }, _) => {
                Self::of_classes(parameters.isovalue, SecondAxis::Value, [2, 2], &[false, true, true, false])
            }
            (Mode::Mean | Mode::XRay | Mode::Mip, _) => {
                Self::of_classes(ABOVE_ZERO, SecondAxis::None, [2, 1], &[false, true])
            }
            (Mode::MinIp, _) => Self::of_classes(1.0, SecondAxis::None, [2, 1], &[true, false]),
            (Mode::Composite, Classifier::PreIntegrated) => {
                Self::of_table(&parameters.lut, SecondAxis::Value)
            }
            (Mode::Composite, Classifier::ValueGradient) => {
                Self::of_table(&parameters.lut, SecondAxis::Gradient)
            }
            (Mode::Composite, Classifier::Value | Classifier::Isovalue) => {
                Self::of_table(&parameters.lut, SecondAxis::None)
            }
        }
    }

    fn of_table(lut: &Lut, second_axis: SecondAxis) -> Self {
        let size = [lut.width(), lut.height()];
        let is_visible = lut.entries().iter().map(|[_, _, _, log2]| *log2 < 0.0);
        Self { value_axis: ValueAxis::Table, second_axis, size, sums: summed(size, is_visible) }
    }

    fn of_classes(threshold: f32, second_axis: SecondAxis, size: [usize; 2], is_visible: &[bool]) -> Self {
        let sums = summed(size, is_visible.iter().copied());
        Self { value_axis: ValueAxis::AtLeast(threshold), second_axis, size, sums }
    }

    /// What the second axis is.
    pub fn second_axis(&self) -> SecondAxis {
        self.second_axis
    }

    /// Entries along the value axis and the second one.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The summed-area table: row by row, `width + 1` numbers in each of `height + 1` rows. Number (column, row) counts the
    /// visible entries before that column in the rows before that row, so that the first column and row are zeros.
    pub fn sums(&self) -> &[u32] {
        &self.sums
    }

    /// Whether any entry from the first to the last of each axis is visible.
    #[inline]
    pub fn is_any_visible(&self, [first, last]: [u16; 2], [first_row, last_row]: [u16; 2]) -> bool {
        let at =
            |column: u16, row: u16| self.sums[usize::from(column) + usize::from(row) * (self.size[0] + 1)];
        let to_row = |row: u16| at(last + 1, row).wrapping_sub(at(first, row));
        to_row(last_row + 1) != to_row(first_row)
    }

    /// Whether a sample can contribute whose normalised value and gradient magnitude lie in the given closed intervals.
    pub fn may_contribute(&self, value: [f32; 2], gradient: [f32; 2]) -> bool {
        let outward = |axis: &dyn Fn(f32) -> [u16; 2], [lo, hi]: [f32; 2]| [axis(lo)[0], axis(hi)[1]];
        let columns = outward(&|x| self.value_axis.entries(x, self.size[0]), value);
        let rows = match self.second_axis {
            SecondAxis::None => [0, 0],
            SecondAxis::Value => columns,
            SecondAxis::Gradient => outward(&|x| ValueAxis::Table.entries(x, self.size[1]), gradient),
        };
        self.is_any_visible(columns, rows)
    }

    /// For each code, the first entry that values from it upwards fall on and the last that values up to it do.
    pub fn value_entries(&self, codes: &RangeCodes, normalised_from_stored: (f64, f64)) -> Vec<[u16; 2]> {
        self.value_axis.entries_of_codes(codes, normalised_from_stored, self.size[0])
    }

    /// The same for the gradient magnitude along the second axis.
    pub fn gradient_entries(&self, codes: &RangeCodes, normalised_from_stored: (f64, f64)) -> Vec<[u16; 2]> {
        ValueAxis::Table.entries_of_codes(codes, normalised_from_stored, self.size[1])
    }

    /// For each code of a smallest value the lowest code of a largest value with which a block can contribute, whatever its
    /// gradients; the number of codes if there is none.
    pub fn occupied_from(&self, codes: &RangeCodes, normalised_from_stored: (f64, f64)) -> Vec<u32> {
        let entries = self.value_entries(codes, normalised_from_stored);
        let is_occupied = |lo: usize, hi: usize| {
            let columns = [entries[lo][0], entries[hi][1]];
            let rows = match self.second_axis {
                SecondAxis::Value => columns,
                SecondAxis::None | SecondAxis::Gradient => [0, (self.size[1] - 1) as u16],
            };
            self.is_any_visible(columns, rows)
        };
        // A wider interval shows no less, so that one walk over both ends finds them all.
        let mut hi = 0;
        (0..entries.len())
            .map(|lo| {
                hi = hi.max(lo);
                while hi < entries.len() && !is_occupied(lo, hi) {
                    hi += 1;
                }
                hi as u32
            })
            .collect()
    }
}

impl ValueAxis {
    /// The entries that a normalised value falls on, whether it is multiplied by their number in f32 or exactly.
    fn entries(self, value: f32, count: usize) -> [u16; 2] {
        match self {
            Self::Table => {
                let along = f64::from(value.clamp(0.0, 1.0)) * (count - 1) as f64;
                [along.floor() as u16, along.ceil() as u16]
            }
            Self::AtLeast(threshold) => [u16::from(value.clamp(0.0, 1.0) >= threshold); 2],
        }
    }

    /// For each code, the first entry that numbers from it upwards fall on and the last that numbers up to it do.
    fn entries_of_codes(
        self,
        codes: &RangeCodes,
        (scale, offset): (f64, f64),
        count: usize,
    ) -> Vec<[u16; 2]> {
        // As the casters normalise: each step rounded to f32.
        let entries = |stored: f32| self.entries(stored * scale as f32 + offset as f32, count);
        let of_code = |code: u16| [entries(codes.lowest(code))[0], entries(codes.highest(code))[1]];
        (0..codes.count).map(|code| of_code(code as u16)).collect()
    }
}

/// Summed-area table with a row and a column of zeros before the entries.
fn summed([width, height]: [usize; 2], is_visible: impl Iterator<Item = bool>) -> Vec<u32> {
    let mut sums = vec![0_u32; (width + 1) * (height + 1)];
    let mut is_visible = is_visible.fuse();
    for row in 1..=height {
        let mut in_row = 0;
        for column in 1..=width {
            in_row += u32::from(is_visible.next().unwrap_or(false));
            let at = column + row * (width + 1);
            sums[at] = sums[at - (width + 1)] + in_row;
        }
    }
    sums
}
