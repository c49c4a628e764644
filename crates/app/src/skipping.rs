//! What rays leap over, as the user asks for it.

use crate::backend::structure_name;
use crate::failure::Failure;
use crate::spec;
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use wheatstone_core::cast::{CastParameters, Classifier};
use wheatstone_core::gradient_map::GradientDepth;
use wheatstone_core::skip::{BlockSize, Skip, SkipHost, SkipPlan, SkipRequest, Structure};
use wheatstone_core::volume::StorageKind;

/// Flags of empty-space skipping.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Empty space")]
pub(crate) struct SkipArgs {
    /// What rays leap over empty space by; the picture stays the same.
    #[arg(long, value_enum)]
    skip: Option<SkipName>,

    /// Voxels along each side of a block, 2 to 16 [default: 4, or as many as keep a structure below a tenth of the volume].
    #[arg(long, value_name = "N", value_parser = spec::block_size, allow_negative_numbers = true)]
    block_size: Option<BlockSize>,

    /// Bits of the gradient magnitudes that two-dimensional transfer functions look up in a map of the volume, which takes
    /// as much memory as a second volume; none estimates them around each sample instead: slower, and a little sharper.
    #[arg(long, value_enum, default_value_t = GradientMapName::Auto)]
    gradient_map: GradientMapName,
}

/// What rays leap by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SkipName {
    /// What suits volume and transfer function.
    Auto,
    /// Nothing.
    None,
    /// Which blocks are occupied.
    Occupancy,
    /// The distance to the nearest occupied block.
    Distance,
    /// The same for each octant of directions.
    Anisotropic,
}

/// Precision of gradient magnitudes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum GradientMapName {
    /// 8 bits for a volume held in 8, else 16.
    Auto,
    /// 8 bits.
    #[value(name = "8")]
    Eight,
    /// 16 bits.
    #[value(name = "16")]
    Sixteen,
    /// No map.
    None,
}

/// What an engine is to make besides the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Skipping {
    /// What rays leap by.
    pub(crate) request: SkipRequest,
    /// Precision of the gradient map of two-dimensional transfer functions.
    pub(crate) gradient_map: GradientMapName,
}

impl Skipping {
    /// By what suits volume and transfer function.
    pub(crate) const AUTO: Self = Self {
        request: SkipRequest { skip: Skip::Auto, block_size: None },
        gradient_map: GradientMapName::Auto,
    };

    /// Precision of the gradient map that some settings look magnitudes up in, over a volume held in a precision; nothing if
    /// they look none up.
    pub(crate) fn gradient_depth(
        &self,
        parameters: &CastParameters,
        storage: StorageKind,
    ) -> Option<GradientDepth> {
        let depth = match self.gradient_map {
            GradientMapName::Auto if storage == StorageKind::U8 => GradientDepth::Bits8,
            GradientMapName::Eight => GradientDepth::Bits8,
            GradientMapName::Auto | GradientMapName::Sixteen => GradientDepth::Bits16,
            GradientMapName::None => return None,
        };
        (parameters.classifier == Classifier::ValueGradient).then_some(depth)
    }
}

impl SkipArgs {
    /// What is asked for; `default` if that is left open.
    pub(crate) fn resolve(&self, default: SkipName) -> Result<Skipping, Failure> {
        let skip = match self.skip.unwrap_or(default) {
            SkipName::Auto => Skip::Auto,
            SkipName::None => Skip::None,
            SkipName::Occupancy => Skip::Occupancy,
            SkipName::Distance => Skip::Distance,
            SkipName::Anisotropic => Skip::Anisotropic,
        };
        if skip == Skip::None && self.block_size.is_some() {
            return Err(Failure::input("--block-size needs a --skip other than none"));
        }
        Ok(Skipping {
            request: SkipRequest { skip, block_size: self.block_size },
            gradient_map: self.gradient_map,
        })
    }
}

/// What a structure takes by default.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StructureBytes {
    name: &'static str,
    side: u32,
    bytes: usize,
    part_of_volume: f64,
}

impl StructureBytes {
    /// One object of a report.
    pub(crate) fn to_json(self) -> Value {
        json!({
            "structure": self.name,
            "block_size": self.side,
            "bytes": self.bytes,
            "part_of_volume": self.part_of_volume,
        })
    }
}

/// What each structure takes by default on a GPU (on the CPU it is no more) for a volume held in a precision: the three
/// maps, and of the default one the ranges of values that it is made from, those of gradients, and the room to work it out
/// in. A tenth of a volume of a few voxels has no room for any.
pub(crate) fn structures(dims: [usize; 3], storage: StorageKind) -> Vec<StructureBytes> {
    let volume_bytes = dims.iter().product::<usize>() * storage.byte_size();
    let row = |name, plan: &SkipPlan, bytes: usize| StructureBytes {
        name,
        side: plan.block_size.sides()[0],
        bytes,
        part_of_volume: bytes as f64 / volume_bytes as f64,
    };
    let host = SkipHost::ANY_GPU;
    let plan = |skip| SkipRequest { skip, block_size: None }.plan(dims, storage, host);
    let default = plan(Skip::Auto).into_iter().flat_map(|plan| {
        let ranges = plan.ranges_byte_size(dims);
        [("ranges", ranges), ("gradient_ranges", ranges), ("working", plan.working_byte_size(dims, host))]
            .map(|(name, bytes)| row(name, &plan, bytes))
    });
    let maps = [
        (Skip::Occupancy, Structure::Occupancy),
        (Skip::Distance, Structure::Distance),
        (Skip::Anisotropic, Structure::Anisotropic),
    ]
    .into_iter()
    .filter_map(|(skip, structure)| plan(skip).filter(|plan| plan.structure == structure))
    .map(|plan| row(structure_name(plan.structure), &plan, plan.byte_size(dims)));
    default.chain(maps).collect()
}

/// Bytes of a gradient map, which is made for two-dimensional transfer functions: those of a second volume, of at most 16
/// bits.
pub(crate) fn gradient_map_bytes(dims: [usize; 3], storage: StorageKind) -> usize {
    dims.iter().product::<usize>() * storage.byte_size().min(2)
}

/// Structures in one line.
pub(crate) fn described(structures: &[StructureBytes]) -> String {
    if structures.is_empty() {
        return "too few voxels to skip any".to_owned();
    }
    let described = |s: &StructureBytes| {
        let kibibytes = s.bytes as f64 / 1024.0;
        format!("{} {kibibytes:.0} KiB ({:.1} %, {}³)", s.name, 100.0 * s.part_of_volume, s.side)
    };
    structures.iter().map(described).collect::<Vec<_>>().join(", ")
}
