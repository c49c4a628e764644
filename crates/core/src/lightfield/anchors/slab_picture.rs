//! What the rays of an anchor pass, slab by slab.

use super::DepthSlabs;
use glam::Vec4;

/// A cell in which nothing is.
pub const CLEAR: u32 = 0;

/// Steps of a channel of the colour of a [`Hider`].
const HIDER_STEPS: f32 = 63.0;

/// Bits below the slab of a hider.
const HIDER_SHIFT: u32 = 18;

/// What the rays of a picture have in each slab of depth, by itself: a cell for each, which is four bytes, red, green, blue and opacity,
/// premultiplied, as if nothing were in front. Cells behind what their ray has ended in are not known, and clear.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SlabPicture {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// How many slabs there are.
    pub count: u32,
    /// Cells of the nearest slab row by row, then those of the next.
    pub cells: Vec<u32>,
    /// What hides the last slabs of each pixel, row by row: a [`Hider`], or [`CLEAR`] where all are seen.
    pub ends: Vec<u32>,
}

/// What a ray has ended in. Six bits each for the number of the slab after it, blue, green and red, so that of two cells the larger one is
/// of what is further back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Hider(u32);

impl Hider {
    /// Of a colour in a slab before [`MOST_SLABS`](super::MOST_SLABS).
    pub fn new(slab: u32, rgb: [f32; 3]) -> Self {
        let [r, g, b] = rgb.map(|channel| (channel.clamp(0.0, 1.0) * HIDER_STEPS + 0.5) as u32);
        Self((slab + 1) << HIDER_SHIFT | b << 12 | g << 6 | r)
    }

    /// That of a word of [`SlabPicture::ends`].
    pub fn of_end(end: u32) -> Option<Self> {
        (end != CLEAR).then_some(Self(end))
    }

    /// Whether a slab is behind it.
    pub fn hides(self, slab: u32) -> bool {
        slab > self.slab()
    }

    /// The slab that it is in.
    pub fn slab(self) -> u32 {
        (self.0 >> HIDER_SHIFT).saturating_sub(1)
    }

    /// Its colour, opaque.
    pub fn color(self) -> Vec4 {
        let [r, g, b] = [0, 6, 12].map(|shift| (self.0 >> shift & 63) as f32 / HIDER_STEPS);
        Vec4::new(r, g, b, 1.0)
    }
}

impl SlabPicture {
    /// One of rays that meet nothing.
    pub fn clear(size: [u32; 2], count: u32) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, count, cells: vec![CLEAR; pixels * count as usize], ends: vec![CLEAR; pixels] }
    }

    /// A cell; clear beyond the picture's sides.
    pub fn cell(&self, slab: u32, column: i64, row: u32) -> u32 {
        let line = slab as usize * self.size[1] as usize + row as usize;
        self.in_line(&self.cells, line, column)
    }

    /// What hides the last slabs of a pixel; nothing beyond the picture's sides.
    pub fn hider(&self, column: i64, row: u32) -> Option<Hider> {
        Hider::of_end(self.in_line(&self.ends, row as usize, column))
    }

    fn in_line(&self, words: &[u32], line: usize, column: i64) -> u32 {
        let width = self.size[0] as usize;
        let inside = usize::try_from(column).ok().filter(|&column| column < width);
        inside.map_or(CLEAR, |column| words[line * width + column])
    }
}

/// The cell that is nearest to a colour, premultiplied RGBA.
pub(super) fn cell_of(color: Vec4) -> u32 {
    u32::from_le_bytes((color * 255.0 + 0.5).to_array().map(|byte| byte as u8))
}

/// Premultiplied RGBA of a cell.
pub fn color_of(cell: u32) -> Vec4 {
    Vec4::from(cell.to_le_bytes().map(f32::from)) / 255.0
}

/// Writes the cells of a ray.
///
/// Bytes are rounded down, and what is lost goes to the next cell that is not clear, so that a fog which no byte could show in any of its
/// slabs is as dense as a whole.
#[derive(Debug)]
pub(crate) struct SlabWriter<'a> {
    /// The ray's cells from the front.
    cells: Vec<&'a mut u32>,
    end: &'a mut u32,
    lost: Vec4,
}

impl<'a> SlabWriter<'a> {
    /// Of a ray that has met nothing so far.
    pub(crate) fn new(cells: Vec<&'a mut u32>, end: &'a mut u32) -> Self {
        Self { cells, end, lost: Vec4::splat(0.5) }
    }

    /// Sets the cell of a slab to what is in it, premultiplied RGBA.
    pub(crate) fn put(&mut self, slab: u32, color: Vec4) {
        let exact = color * 255.0 + self.lost;
        let bytes = exact.floor().clamp(Vec4::ZERO, Vec4::splat(255.0));
        self.lost = exact - bytes;
        *self.cells[slab as usize] = u32::from_le_bytes(bytes.to_array().map(|byte| byte as u8));
    }

    /// Marks what is behind a slab as hidden by something of a colour.
    pub(crate) fn hide_behind(&mut self, slab: u32, rgb: [f32; 3]) {
        *self.end = Hider::new(slab, rgb).0;
    }
}

impl DepthSlabs {
    /// Bytes of the cells of a picture.
    pub fn byte_size(&self, [width, height]: [u32; 2]) -> u64 {
        4 * u64::from(width) * u64::from(height) * u64::from(self.count)
    }
}
