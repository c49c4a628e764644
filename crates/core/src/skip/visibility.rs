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
        entries_of_codes(codes, normalised_from_stored, self.value_axis, self.size[0])
    }

    /// The same for the gradient magnitude along the second axis.
    pub fn gradient_entries(&self, codes: &RangeCodes, normalised_from_stored: (f64, f64)) -> Vec<[u16; 2]> {
        entries_of_codes(codes, normalised_from_stored, ValueAxis::Table, self.size[1])
    }

    /// All entries of the second axis.
    pub(super) fn all_rows(&self) -> [u16; 2] {
        [0, (self.size[1] - 1) as u16]
    }
}

impl ValueAxis {
    /// The entries that a normalised value in f32 falls on.
    fn entries(self, value: f32, count: usize) -> [u16; 2] {
        match self {
            Self::Table => {
                let along = value.clamp(0.0, 1.0) * (count - 1) as f32;
                [along.floor() as u16, along.ceil() as u16]
            }
            Self::AtLeast(threshold) => [u16::from(value.clamp(0.0, 1.0) >= threshold); 2],
        }
    }

    /// The same in f64.
    fn entries_f64(self, value: f64, count: usize) -> [u16; 2] {
        match self {
            Self::Table => {
                let along = value.clamp(0.0, 1.0) * (count - 1) as f64;
                [along.floor() as u16, along.ceil() as u16]
            }
            Self::AtLeast(threshold) => [u16::from(value.clamp(0.0, 1.0) >= f64::from(threshold)); 2],
        }
    }
}

/// The entries of each code, whichever way a sampler normalises: in f32, in f64 with the f32 or the f64 map, or in f32 with
/// a fused multiplication.
fn entries_of_codes(
    codes: &RangeCodes,
    (scale, offset): (f64, f64),
    axis: ValueAxis,
    count: usize,
) -> Vec<[u16; 2]> {
    let (scale_f32, offset_f32) = (scale as f32, offset as f32);
    let entries = |stored: f32| {
        let wide = f64::from(stored) * f64::from(scale_f32) + f64::from(offset_f32);
        let all = [
            axis.entries(stored * scale_f32 + offset_f32, count),
            axis.entries(wide as f32, count),
            axis.entries_f64(wide, count),
            axis.entries_f64(f64::from(stored) * scale + offset, count),
        ];
        all.into_iter().fold(all[0], |[first, last], [f, l]| [first.min(f), last.max(l)])
    };
    let of_code = |code: u16| [entries(codes.lowest(code))[0], entries(codes.highest(code))[1]];
    (0..codes.count).map(|code| of_code(code as u16)).collect()
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
