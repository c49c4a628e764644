//! How far each block is from the nearest occupied one.

use super::distance::{Reach, along_x, along_y, along_z};
use super::{BlockGrid, Occupancy};
use rayon::prelude::*;

/// Groups of ray directions by the signs of their components.
pub const OCTANTS: usize = 8;

/// What a skip map tells of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Structure {
    /// Whether it is occupied (DM §3.3): 0 if it is, else 1.
    Occupancy,
    /// The Chebyshev distance in blocks to the nearest occupied block (DM §3.5), at most 255.
    Distance,
    /// The same for each octant of directions, counting the blocks in it only (DM §3.6).
    Anisotropic,
}

impl Structure {
    /// How many numbers a block has.
    pub fn octants(self) -> usize {
        match self {
            Self::Occupancy | Self::Distance => 1,
            Self::Anisotropic => OCTANTS,
        }
    }
}

/// Blocks that a ray may leap over, from each block: a cube of this many blocks around it (occupancy and distance) or
/// from it onwards (anisotropic) holds no occupied one. 0 is occupied. Beyond the grid everything is empty.
///
/// An octant is a number: bit 0, 1 or 2 is set if the ray's direction along x, y or z is negative.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SkipMap {
    grid: BlockGrid,
    structure: Structure,
    distances: Vec<u8>,
}

impl SkipMap {
    /// Finds the distances, in time proportional to the number of blocks.
    pub fn new(occupancy: &Occupancy, structure: Structure) -> Self {
        let grid = *occupancy.grid();
        let distances = match structure {
            Structure::Occupancy => occupancy.occupied().par_iter().map(|&o| u8::from(!o)).collect(),
            Structure::Distance => isotropic(occupancy),
            Structure::Anisotropic => anisotropic(occupancy),
        };
        Self { grid, structure, distances }
    }

    /// The blocks.
    pub fn grid(&self) -> &BlockGrid {
        &self.grid
    }

    /// What the numbers are.
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// The number of a block for rays of an octant; all octants are the same unless the map is anisotropic.
    #[inline]
    pub fn at(&self, block: [usize; 3], octant: usize) -> u8 {
        self.octant(octant)[self.grid.index(block)]
    }

    /// The numbers for rays of an octant, in the order of [`BlockGrid::index`].
    pub fn octant(&self, octant: usize) -> &[u8] {
        let count = self.grid.block_count();
        match self.structure {
            Structure::Occupancy | Structure::Distance => &self.distances,
            Structure::Anisotropic => &self.distances[octant * count..(octant + 1) * count],
        }
    }

    /// All numbers: one block after the other, one octant after the other.
    pub fn distances(&self) -> &[u8] {
        &self.distances
    }

    /// Bytes that the numbers take.
    pub fn byte_size(&self) -> usize {
        self.distances.len()
    }
}

fn isotropic(occupancy: &Occupancy) -> Vec<u8> {
    let dims = occupancy.grid().dims();
    let mut cells = unreached(occupancy);
    along_x(&mut cells, dims, Reach::Both);
    along_y(&mut cells, dims, [Reach::Both; 2]);
    along_z(&mut cells, dims, [Reach::Both; 3]);
    cells
}

/// The passes along x and y are shared by the octants that they serve: 2 + 4 + 8 in all.
fn anisotropic(occupancy: &Occupancy) -> Vec<u8> {
    const SIDES: [Reach; 2] = [Reach::Up, Reach::Down];
    let dims = occupancy.grid().dims();
    let halves = SIDES.map(|x| {
        let mut cells = unreached(occupancy);
        along_x(&mut cells, dims, x);
        cells
    });
    let quarters = [0, 1, 2, 3].map(|quarter| {
        let mut cells = halves[quarter & 1].clone();
        along_y(&mut cells, dims, [SIDES[quarter & 1], SIDES[quarter >> 1]]);
        cells
    });
    let block_count = occupancy.grid().block_count();
    let mut distances = vec![0; OCTANTS * block_count];
    distances.par_chunks_mut(block_count).enumerate().for_each(|(octant, cells)| {
        cells.copy_from_slice(&quarters[octant & 3]);
        along_z(cells, dims, [SIDES[octant & 1], SIDES[octant >> 1 & 1], SIDES[octant >> 2]]);
    });
    distances
}

/// Distances before any are known: 0 for occupied blocks, 255 for empty ones.
fn unreached(occupancy: &Occupancy) -> Vec<u8> {
    occupancy.occupied().par_iter().map(|&is_occupied| if is_occupied { 0 } else { u8::MAX }).collect()
}
