//! Empty-space skipping: what of a volume cannot be seen, and how far a ray may leap over it.
//!
//! The volume is cut into *blocks*. Once per volume, [`BlockRanges`] holds the interval of the values (and of the gradient
//! magnitudes) that a trilinear sample in each block can have. Once per change of the settings, [`Visibility`] tells which
//! intervals can contribute to a picture, [`Occupancy`] which blocks can, and [`SkipMap`] how far each block is from the
//! nearest one that can. No voxel is read again. A ray then leaps out of the blocks that are nearer (DM Eq. 14).
//!
//! DM is Deakin and Knackstedt 2020, “Efficient ray casting of volumetric images using distance maps for empty space
//! skipping”.

mod block_extremes;
mod block_grid;
mod block_ranges;
mod block_size;
mod choice;
mod distance;
mod extremes;
mod field_layout;
mod host;
mod margin;
mod occupancy;
mod range_codes;
mod skip_map;
mod visibility;
mod voxel_occupancy;

pub use block_extremes::BlockExtremes;
pub use block_grid::BlockGrid;
pub use block_ranges::BlockRanges;
pub use block_size::{BlockSize, SkipError};
pub use choice::{Skip, SkipPlan, SkipRequest};
pub use field_layout::FieldLayout;
pub use host::SkipHost;
pub use margin::margin_blocks;
pub use occupancy::{NormalisedRanges, Occupancy};
pub use range_codes::RangeCodes;
pub use skip_map::{OCTANTS, SkipMap, Structure};
pub use visibility::{SecondAxis, Visibility};
pub use voxel_occupancy::voxel_occupancy;
