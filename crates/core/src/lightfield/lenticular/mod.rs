//! Panels behind slanted lenses: which view each sub-pixel shows.

mod interlace;
mod visual_json;

use super::DisplayError;
use super::error::{check, check_size_px};
use rayon::prelude::*;

/// How the lenses of one display lie on its panel, as measured by its maker: the numbers of the display's `visual.json`.
///
/// Lengths are in the maker's units: the pitch in lenses per inch across them, the slope as height over width, the centre in
/// lenses.
#[derive(Debug, Clone, PartialEq)]
pub struct Lenticular {
    /// Lenses per inch, across them.
    pub pitch_per_inch: f64,
    /// Height over width of the lenses' slant; its sign tells which way they lean.
    pub slope: f64,
    /// Lenses by which the first is shifted.
    pub center: f64,
    /// Angle of the cone of directions that one lens sends out, degrees.
    pub view_cone_deg: f64,
    /// Whether directions are counted from the right under each lens, as on all displays sold so far.
    pub views_run_left: bool,
    /// Pixels of the panel per inch.
    pub dots_per_inch: f64,
    /// Width and height of the panel, pixels.
    pub panel_px: [u32; 2],
    /// Whether the panel shows left and right exchanged.
    pub flips_x: bool,
    /// Whether the panel shows top and bottom exchanged.
    pub flips_y: bool,
    /// Whether the sub-pixels are blue, green, red from the left.
    pub flips_subpixels: bool,
    /// Which of the cells a pixel has.
    pub cell_pattern: CellPattern,
    /// Places of the sub-pixels in a pixel; empty if they are stripes of a third each.
    pub cells: Vec<SubpixelCell>,
}

/// Places of a pixel's sub-pixels from its middle, pixels to the right and up: red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubpixelCell {
    /// Of each channel.
    pub offsets_px: [[f64; 2]; 3],
}

/// Which cell a pixel of column x and row y has, rows counted from the bottom: `CellPatternMode`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CellPattern {
    /// The first one (0).
    #[default]
    One,
    /// The first where x + y is even, else the second (1).
    Checkered,
    /// The first in even columns, else the second (2).
    Columns,
    /// (y + 2 (x mod 2)) mod 4 (3).
    Quadruple,
    /// The first in even rows, else the second (4).
    Rows,
}

/// Least number of lenses across a panel: displays have a hundred and more.
const FEWEST_LENSES: f64 = 10.0;

/// Most places of sub-pixels in a calibration.
const MOST_CELLS: usize = 10;

impl CellPattern {
    /// The cell of a pixel; its row is counted from the bottom.
    pub fn cell(self, column: u32, row_from_bottom: u32) -> usize {
        let (x, y) = (column as usize, row_from_bottom as usize);
        match self {
            Self::One => 0,
            Self::Checkered => (x + y) % 2,
            Self::Columns => x % 2,
            Self::Quadruple => (y + x % 2 * 2) % 4,
            Self::Rows => y % 2,
        }
    }

    /// Cells that it tells apart.
    fn cell_count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Checkered | Self::Columns | Self::Rows => 2,
            Self::Quadruple => 4,
        }
    }
}

impl Lenticular {
    /// The same if it can be one.
    ///
    /// # Errors
    /// Numbers that are not finite or out of their bounds, lenses that are fewer across the panel than 10 or more than its sub-pixels, fewer
    /// cells than their pattern has.
    pub fn checked(self) -> Result<Self, DisplayError> {
        let Self { pitch_per_inch, slope, center, view_cone_deg, dots_per_inch, .. } = self;
        let is_pitch = pitch_per_inch > 0.0 && pitch_per_inch <= 1e4;
        check(is_pitch, "pitch", pitch_per_inch, "above 0 and at most 10000")?;
        check(
            slope.abs() >= 1e-3 && slope.abs() <= 1e6,
            "slope",
            slope,
            "from 0.001 to 1000000, or negative so",
        )?;
        check(center.abs() <= 1e4, "center", center, "from -10000 to 10000")?;
        let is_cone = view_cone_deg > 0.0 && view_cone_deg < 180.0;
        check(is_cone, "viewCone", view_cone_deg, "above 0 and below 180")?;
        let is_density = (1.0..=1e5).contains(&dots_per_inch);
        check(is_density, "DPI", dots_per_inch, "from 1 to 100000")?;
        check_size_px("screenW, screenH", self.panel_px)?;
        self.check_lens_count()?;
        if self.cells.len() > MOST_CELLS
            || (!self.cells.is_empty() && self.cells.len() < self.cell_pattern.cell_count())
        {
            let (field, count) = ("subpixelCells", self.cells.len());
            let expected = "as many as CellPatternMode tells apart, and at most 10";
            return Err(DisplayError::Count { field, count, expected });
        }
        for (index, cell) in self.cells.iter().enumerate() {
            for offset in cell.offsets_px.into_iter().flatten() {
                check(
                    offset.abs() <= 10.0,
                    format!("subpixelCells[{index}]"),
                    offset,
                    "from -10 to 10 pixels",
                )?;
            }
        }
        Ok(self)
    }

    fn check_lens_count(&self) -> Result<(), DisplayError> {
        let Self { pitch_per_inch, slope, dots_per_inch, .. } = *self;
        let (lenses, most) = (self.lenses_across(), 3 * self.panel_px[0]);
        if (FEWEST_LENSES..=f64::from(most)).contains(&lenses) {
            return Ok(());
        }
        Err(DisplayError::LensCount { pitch_per_inch, slope, dots_per_inch, lenses, most })
    }

    /// Lenses that a row of the panel crosses (`ProcessPitch` of the maker's toolkit).
    pub fn lenses_across(&self) -> f64 {
        let [width, _] = self.panel_px.map(f64::from);
        self.pitch_per_inch * width / self.dots_per_inch * self.slope.recip().atan().cos()
    }

    /// By how many widths of the panel a lens leans from its bottom to its top (`ProcessSlope`).
    pub fn tilt(&self) -> f64 {
        let [width, height] = self.panel_px.map(f64::from);
        let tilt = height / (width * self.slope);
        if self.flips_x { -tilt } else { tilt }
    }

    /// Where under its lens the sub-pixel of a channel is, as a share of the view cone from the left: in (0, 1] if views run to the left,
    /// else in [0, 1).
    pub fn share(&self, column: u32, row: u32, channel: usize) -> f64 {
        let [width, height] = self.panel_px;
        let (columns, rows) = (f64::from(width), f64::from(height));
        let row_from_bottom = height - 1 - row;
        let [right_px, up_px] = self.offset_px(column, row_from_bottom, channel);
        let x = (f64::from(column) + 0.5 + right_px) / columns;
        let y = (f64::from(row_from_bottom) + 0.5 + up_px) / rows;
        let lens = (x + y * self.tilt()) * self.lenses_across() - self.center;
        let across = lens - lens.floor();
        if self.views_run_left { 1.0 - across } else { across }
    }

    /// Which of so many views a sub-pixel shows.
    pub fn view(&self, column: u32, row: u32, channel: usize, view_count: u32) -> u32 {
        ((self.share(column, row, channel) * f64::from(view_count)) as u32).min(view_count - 1)
    }

    /// The views that the red, green and blue of each pixel show, of at most 256, row by row from the top left.
    ///
    /// # Panics
    /// If there are more views.
    pub fn views(&self, view_count: u32) -> Vec<[u8; 3]> {
        assert!(view_count <= 256, "{view_count} views: a byte tells 256 apart");
        let [width, height] = self.panel_px;
        let of_pixel =
            |column, row| [0, 1, 2].map(|channel| self.view(column, row, channel, view_count) as u8);
        let rows = (0..height).into_par_iter();
        rows.flat_map_iter(|row| (0..width).map(move |column| of_pixel(column, row))).collect()
    }

    /// From the middle of a pixel; without cells, from where the maker's software takes its red stripe to be. On a panel that exchanges left
    /// and right stripes go to the left, as in the maker's Unity plugin (`subpixelSize`) and in 0.6.0 of its `webxr` (`subp`), and not yet in
    /// its older `holoplay-core`.
    fn offset_px(&self, column: u32, row_from_bottom: u32, channel: usize) -> [f64; 2] {
        let channel = if self.flips_subpixels { 2 - channel } else { channel };
        if self.cells.is_empty() {
            let right_px = channel as f64 / 3.0;
            return [if self.flips_x { -right_px } else { right_px }, 0.0];
        }
        let cell = self.cell_pattern.cell(column, row_from_bottom);
        self.cells[cell % self.cells.len()].offsets_px[channel]
    }
}
