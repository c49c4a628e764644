//! Which structure rays leap by where a user leaves that open.

use super::{BlockGrid, BlockSize, OCTANTS, Structure};
use crate::volume::StorageKind;

/// What a user asks rays to leap by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Skip {
    /// What suits the volume and the transfer function.
    #[default]
    Auto,
    /// Nothing: every sample is taken.
    None,
    /// Which blocks are occupied.
    Occupancy,
    /// The distance to the nearest occupied block.
    Distance,
    /// The same in each octant of directions.
    Anisotropic,
}

/// What a user asks for: a structure and a size of its blocks, each of which may be left open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SkipRequest {
    /// The structure.
    pub skip: Skip,
    /// The size of its blocks; `None` is the smallest that is worth its memory.
    pub block_size: Option<BlockSize>,
}

/// Whether the transfer function is about to change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// While it is dragged: a map lasts for a frame.
    Editing,
    /// When it rests: a map lasts for many.
    Idle,
}

/// A structure that is to be made of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkipPlan {
    /// The structure.
    pub structure: Structure,
    /// The size of its blocks.
    pub block_size: BlockSize,
    is_open: bool,
}

/// Largest part of a volume's bytes that a structure of its own choice takes.
const MOST_OF_VOLUME: f64 = 0.1;

/// Side of the blocks where memory allows: with smaller ones the ranges of an 8-bit volume alone take 15 % of it, with
/// larger ones rays leap less.
const SIDE: u32 = 4;

/// Bytes of a block's range of values.
const RANGE_BYTES: usize = size_of::<[u16; 2]>();

/// Occupied part of the blocks above which leaping is not worth the reads of the map.
const MOST_OCCUPIED: f64 = 0.75;

impl SkipRequest {
    /// What to make of a volume whose voxels are held in a precision; nothing if nothing is asked for.
    ///
    /// Left open, the structure is a distance map while the transfer function is edited, because it is made quickly, and an
    /// anisotropic one when it rests. Blocks are of 4³ voxels, or larger where the structure or the ranges that it is made
    /// from would take more than a tenth of the volume's bytes: 5³ for an anisotropic map of an 8-bit volume. Blocks do not
    /// change with the pace, so that the ranges serve both.
    pub fn plan(self, storage: StorageKind, pace: Pace) -> Option<SkipPlan> {
        let at_rest = match self.skip {
            Skip::None => return None,
            Skip::Occupancy => Structure::Occupancy,
            Skip::Distance => Structure::Distance,
            Skip::Auto | Skip::Anisotropic => Structure::Anisotropic,
        };
        let block_size = self.block_size.or_else(|| smallest_blocks(at_rest, storage))?;
        let is_open = self.skip == Skip::Auto;
        let structure = if is_open && pace == Pace::Editing { Structure::Distance } else { at_rest };
        Some(SkipPlan { structure, block_size, is_open })
    }
}

impl SkipPlan {
    /// The same blocks with another structure.
    pub fn with_structure(self, structure: Structure) -> Self {
        Self { structure, ..self }
    }

    /// A structure that is asked for by name.
    pub fn new(structure: Structure, block_size: BlockSize) -> Self {
        Self { structure, block_size, is_open: false }
    }

    /// Whether leaping is faster than taking every sample, where the given part of the blocks is occupied. What a user asks
    /// for by name is not judged.
    pub fn pays(&self, occupied_fraction: f64) -> bool {
        !self.is_open || occupied_fraction <= MOST_OCCUPIED
    }

    /// Bytes of the structure over a volume.
    pub fn byte_size(&self, volume_dims: [usize; 3]) -> usize {
        self.block_count(volume_dims) * bytes_per_block(self.structure)
    }

    /// Bytes of the ranges of values that the structure is made from. Those of gradients take as many.
    pub fn ranges_byte_size(&self, volume_dims: [usize; 3]) -> usize {
        self.block_count(volume_dims) * RANGE_BYTES
    }

    fn block_count(&self, volume_dims: [usize; 3]) -> usize {
        BlockGrid::new(volume_dims, self.block_size).block_count()
    }
}

fn bytes_per_block(structure: Structure) -> usize {
    match structure {
        Structure::Occupancy | Structure::Distance => 1,
        Structure::Anisotropic => OCTANTS,
    }
}

/// The smallest blocks that are worth their memory.
fn smallest_blocks(structure: Structure, storage: StorageKind) -> Option<BlockSize> {
    let bytes_per_block = bytes_per_block(structure).max(RANGE_BYTES) as f64;
    let bytes_per_voxel = storage.byte_size() as f64;
    (SIDE..=BlockSize::LARGEST)
        .find(|side| bytes_per_block <= MOST_OF_VOLUME * bytes_per_voxel * f64::from(side.pow(3)))
        .and_then(|side| BlockSize::cube(side).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [StorageKind; 3] = [StorageKind::U8, StorageKind::U16, StorageKind::F32];
    const ALL: [Skip; 4] = [Skip::Auto, Skip::Occupancy, Skip::Distance, Skip::Anisotropic];

    fn asked(skip: Skip) -> SkipRequest {
        SkipRequest { skip, block_size: None }
    }

    #[test]
    fn no_structure_takes_more_than_a_tenth_of_the_volume() {
        const DIMS: [usize; 3] = [240; 3];
        for (kind, skip, pace) in KINDS
            .into_iter()
            .flat_map(|kind| ALL.map(|skip| (kind, skip)))
            .flat_map(|(kind, skip)| [Pace::Editing, Pace::Idle].map(|pace| (kind, skip, pace)))
        {
            let plan = asked(skip).plan(kind, pace).unwrap();
            let allowed = 240 * 240 * 240 * kind.byte_size() / 10;
            let found = (plan.byte_size(DIMS), plan.ranges_byte_size(DIMS));
            assert!(found.0 <= allowed && found.1 <= allowed, "{kind:?} {plan:?}: {found:?} of {allowed}");
        }
    }

    #[test]
    fn what_is_asked_for_is_made() {
        let block_size = Some(BlockSize::cube(2).unwrap());
        for pace in [Pace::Editing, Pace::Idle] {
            let plan = |skip| SkipRequest { skip, block_size }.plan(StorageKind::U8, pace);
            assert_eq!(plan(Skip::None), None);
            assert_eq!(plan(Skip::Anisotropic).unwrap().structure, Structure::Anisotropic);
            assert_eq!(plan(Skip::Occupancy).unwrap().structure, Structure::Occupancy);
            assert!(ALL.iter().all(|&skip| Some(plan(skip).unwrap().block_size) == block_size));
            assert!(plan(Skip::Distance).unwrap().pays(1.0));
        }
    }

    #[test]
    fn ranges_serve_both_paces_and_full_volumes_are_left_alone() {
        for kind in KINDS {
            let [editing, idle] =
                [Pace::Editing, Pace::Idle].map(|pace| asked(Skip::Auto).plan(kind, pace).unwrap());
            assert_eq!(editing.structure, Structure::Distance);
            assert_eq!(editing.block_size, idle.block_size);
            assert!(idle.pays(0.3) && !idle.pays(0.99));
        }
    }
}
