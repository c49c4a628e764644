//! Which structure rays leap by where a user leaves that open.

use super::{BlockGrid, BlockSize, SkipHost, Structure};
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

/// A structure that is to be made of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkipPlan {
    /// The structure.
    pub structure: Structure,
    /// The one that is made while the transfer function is dragged, when a map lasts for a frame.
    pub while_edited: Structure,
    /// The size of the blocks of both, so that the same ranges serve them.
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
    /// Left open, the structure is an anisotropic map, and a distance map while the transfer function is edited, because it
    /// is made quickly. Blocks are of 4³ voxels, or larger where the structure, the ranges that it is made from or what
    /// working it out takes would be more than a tenth of the volume's bytes: 5³ for an anisotropic map of an 8-bit volume.
    /// If no blocks are large enough, as those of a volume of a few voxels, nothing is made. Where the host cannot hold an
    /// anisotropic map, or it would take too much, a distance map takes its place.
    pub fn plan(self, volume_dims: [usize; 3], storage: StorageKind, host: SkipHost) -> Option<SkipPlan> {
        let is_open = self.skip == Skip::Auto;
        let plan = |structure| {
            let while_edited = if is_open { Structure::Distance } else { structure };
            let with_blocks = |block_size| SkipPlan { structure, while_edited, block_size, is_open };
            let most = MOST_OF_VOLUME * (volume_dims.iter().product::<usize>() * storage.byte_size()) as f64;
            match self.block_size {
                Some(block_size) => Some(with_blocks(block_size)),
                None => (SIDE..=BlockSize::LARGEST)
                    .filter_map(|side| BlockSize::cube(side).ok())
                    .map(with_blocks)
                    .find(|plan| plan.largest_byte_size(volume_dims, host) as f64 <= most),
            }
        };
        match self.skip {
            Skip::None => None,
            Skip::Occupancy => plan(Structure::Occupancy),
            Skip::Distance => plan(Structure::Distance),
            Skip::Auto | Skip::Anisotropic => plan(Structure::Anisotropic)
                .filter(|plan| host.can_hold(&plan.grid(volume_dims), plan.structure))
                .or_else(|| plan(Structure::Distance)),
        }
    }
}

impl SkipPlan {
    /// Whether leaping is faster than taking every sample, where the given part of the blocks is occupied. What a user asks
    /// for by name is not judged.
    pub fn pays(&self, occupied_fraction: f64) -> bool {
        !self.is_open || occupied_fraction <= MOST_OCCUPIED
    }

    /// Bytes of the structure over a volume.
    pub fn byte_size(&self, volume_dims: [usize; 3]) -> usize {
        self.structure.octants() * self.grid(volume_dims).block_count()
    }

    /// Bytes of the ranges of values that the structure is made from. Those of gradients take as many.
    pub fn ranges_byte_size(&self, volume_dims: [usize; 3]) -> usize {
        RANGE_BYTES * self.grid(volume_dims).block_count()
    }

    /// Bytes, at most, that working the structure out takes besides it.
    pub fn working_byte_size(&self, volume_dims: [usize; 3], host: SkipHost) -> usize {
        host.working_byte_size(&self.grid(volume_dims), self.structure)
    }

    /// Bytes of the largest of them all.
    fn largest_byte_size(&self, volume_dims: [usize; 3], host: SkipHost) -> usize {
        self.byte_size(volume_dims)
            .max(self.ranges_byte_size(volume_dims))
            .max(self.working_byte_size(volume_dims, host))
    }

    fn grid(&self, volume_dims: [usize; 3]) -> BlockGrid {
        BlockGrid::new(volume_dims, self.block_size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [StorageKind; 3] = [StorageKind::U8, StorageKind::U16, StorageKind::F32];
    const ALL: [Skip; 4] = [Skip::Auto, Skip::Occupancy, Skip::Distance, Skip::Anisotropic];
    const HOSTS: [SkipHost; 2] = [SkipHost::Cpu, SkipHost::ANY_GPU];
    const CUBE: [usize; 3] = [240; 3];

    fn asked(skip: Skip) -> SkipRequest {
        SkipRequest { skip, block_size: None }
    }

    /// Bytes of each structure that a plan makes, by hand.
    fn byte_sizes(plan: &SkipPlan, dims: [usize; 3], host: SkipHost) -> [usize; 4] {
        let side = plan.block_size.sides()[0] as usize;
        let [width, height, depth] = dims.map(|n| n.div_ceil(side));
        let count = width * height * depth;
        let octants = if plan.structure == Structure::Anisotropic { 8 } else { 1 };
        let row = match host {
            SkipHost::Cpu => octants * width,
            SkipHost::Gpu { .. } => (octants * width.div_ceil(16) * 16).div_ceil(256) * 256,
        };
        [octants * count, count, 4 * count, row * height * depth]
    }

    #[test]
    fn no_structure_takes_more_than_a_tenth_of_the_volume() {
        const SIDES: [usize; 9] = [1, 2, 3, 7, 16, 17, 61, 256, 1021];
        let all_dims = SIDES
            .into_iter()
            .flat_map(|x| SIDES.into_iter().flat_map(move |y| SIDES.into_iter().map(move |z| [x, y, z])));
        for dims in all_dims {
            for (kind, skip) in KINDS.into_iter().flat_map(|kind| ALL.map(|skip| (kind, skip))) {
                for host in HOSTS {
                    let allowed = dims.iter().product::<usize>() * kind.byte_size() / 10;
                    let within = |plan: &SkipPlan| {
                        byte_sizes(plan, dims, host).into_iter().all(|bytes| bytes <= allowed)
                    };
                    match asked(skip).plan(dims, kind, host) {
                        Some(plan) => {
                            assert!(within(&plan), "{dims:?} {kind:?} {host:?} {plan:?}");
                            let [map, _, ranges, working] = byte_sizes(&plan, dims, host);
                            assert_eq!(plan.byte_size(dims), map);
                            assert_eq!(plan.ranges_byte_size(dims), ranges);
                            assert_eq!(plan.working_byte_size(dims, host), working);
                        }
                        None => {
                            let block_size = BlockSize::cube(BlockSize::LARGEST).ok();
                            let least = SkipRequest { skip: Skip::Distance, block_size };
                            let plan = least.plan(dims, kind, host).unwrap();
                            assert!(!within(&plan), "{dims:?} {kind:?} {host:?}: room for {plan:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_asked_for_is_made() {
        let block_size = Some(BlockSize::cube(2).unwrap());
        for (host, dims) in HOSTS.into_iter().flat_map(|host| [CUBE, [1, 1, 9]].map(|dims| (host, dims))) {
            let plan = |skip| SkipRequest { skip, block_size }.plan(dims, StorageKind::U8, host);
            assert_eq!(plan(Skip::None), None);
            for (skip, structure) in [
                (Skip::Anisotropic, Structure::Anisotropic),
                (Skip::Occupancy, Structure::Occupancy),
                (Skip::Distance, Structure::Distance),
            ] {
                let plan = plan(skip).unwrap();
                assert_eq!([plan.structure, plan.while_edited], [structure; 2]);
            }
            assert!(ALL.iter().all(|&skip| Some(plan(skip).unwrap().block_size) == block_size));
            assert!(plan(Skip::Distance).unwrap().pays(1.0));
        }
    }

    #[test]
    fn what_is_left_open_is_quick_while_edited_and_full_volumes_are_left_alone() {
        for (kind, host) in KINDS.into_iter().flat_map(|kind| HOSTS.map(|host| (kind, host))) {
            let plan = asked(Skip::Auto).plan(CUBE, kind, host).unwrap();
            assert_eq!([plan.while_edited, plan.structure], [Structure::Distance, Structure::Anisotropic]);
            assert!(plan.pays(0.3) && !plan.pays(0.99));
        }
        let plan = asked(Skip::Auto).plan(CUBE, StorageKind::U8, SkipHost::ANY_GPU).unwrap();
        assert_eq!(plan.block_size, BlockSize::cube(5).unwrap());
    }

    #[test]
    fn octants_that_a_device_cannot_stack_give_way_to_one_map() {
        let dims = [64, 64, 1024];
        let gpu = |largest_side, largest_buffer| SkipHost::Gpu { largest_side, largest_buffer };
        for block_size in [None, BlockSize::cube(2).ok()] {
            for skip in [Skip::Auto, Skip::Anisotropic] {
                let structure = |host| {
                    let plan = SkipRequest { skip, block_size }.plan(dims, StorageKind::U8, host).unwrap();
                    (plan.structure, plan.while_edited)
                };
                let one_map = (Structure::Distance, Structure::Distance);
                assert_eq!(structure(gpu(1024, usize::MAX)), one_map);
                assert_eq!(structure(gpu(usize::MAX, 1 << 17)), one_map);
                assert_eq!(structure(gpu(4096, 1 << 27)).0, Structure::Anisotropic);
            }
        }
    }
}
