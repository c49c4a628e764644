//! Raw voxels: no header, the first axis fastest.
//!
//! The layout comes from the user, or from a name in the convention of the Open `SciVis` Datasets
//! (<https://klacansky.com/open-scivis-datasets/>): `NAME_WIDTHxHEIGHTxDEPTH_TYPE.raw`.

use crate::{
    Format, Loaded, ReadError, geometry,
    stream::Stream,
    voxel_data::{self, Layout, Scalar},
};
use glam::DVec3;
use wheatstone_core::volume::{Grid, VoxelType};

/// What a raw file does not say itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RawLayout {
    /// Voxels along each axis, the fastest first.
    pub dims: [u64; 3],
    /// Scalar type of a voxel.
    pub voxel_type: VoxelType,
    /// Distance between voxel centres along each axis.
    pub spacing_mm: [f64; 3],
    /// Whether the most significant byte of a voxel comes first.
    pub big_endian: bool,
    /// Bytes before the first voxel.
    pub header_bytes: u64,
}

impl RawLayout {
    /// Little-endian voxels of 1 mm without a header.
    pub fn new(dims: [u64; 3], voxel_type: VoxelType) -> Self {
        Self { dims, voxel_type, spacing_mm: [1.0; 3], big_endian: false, header_bytes: 0 }
    }

    /// The layout that a file name tells, such as `bonsai_256x256x256_uint8.raw`; `None` if it tells none.
    pub fn from_file_name(name: &str) -> Option<Self> {
        let stem = name.split('.').next()?;
        let words: Vec<&str> = stem.split('_').collect();
        words.windows(2).rev().find_map(|pair| {
            let mut sizes = pair[0].split(['x', 'X']).map(|size| size.parse().ok());
            let dims = [sizes.next()??, sizes.next()??, sizes.next()??];
            let voxel_type = VoxelType::ALL.iter().find(|t| t.name().eq_ignore_ascii_case(pair[1]))?;
            sizes.next().is_none().then(|| Self::new(dims, *voxel_type))
        })
    }
}

pub(crate) fn read(mut stream: Stream<'_>, layout: &RawLayout) -> Result<Loaded, ReadError> {
    if let Some(axis) = layout.dims.iter().position(|&d| d == 0) {
        return Err(ReadError::BadDimension { field: "dims", axis: axis + 1, value: 0 });
    }
    let (dims, voxel_count) = voxel_data::checked_voxel_count(layout.dims, layout.voxel_type.byte_size())?;
    let field = "spacing_mm";
    let spacing_mm = DVec3::from(layout.spacing_mm);
    geometry::grid(dims, geometry::diagonal(spacing_mm), field)?;
    let centred = Grid::centred(dims, layout.spacing_mm);
    let grid = centred.map_err(|_| ReadError::NotInvertible { field, matrix: spacing_mm.to_string() })?;
    stream.skip(layout.header_bytes)?;
    let mut warnings = Vec::new();
    let layout = Layout::dense(Scalar::Voxel(layout.voxel_type), layout.big_endian, voxel_count);
    let voxels = voxel_data::read_binary(&mut stream, layout, &mut warnings)?;
    Loaded::new(grid, voxels, warnings, Format::Raw)
}
