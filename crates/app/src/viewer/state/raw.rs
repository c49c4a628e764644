//! The form of a raw file's layout.

use crate::spec;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};
use wheatstone_core::volume::VoxelType;
use wheatstone_io::RawLayout;

#[derive(Serialize, Deserialize)]
#[serde(remote = "RawLayout", deny_unknown_fields)]
struct Form {
    dims: [u64; 3],
    #[serde(serialize_with = "write_type", deserialize_with = "read_type")]
    voxel_type: VoxelType,
    spacing_mm: [f64; 3],
    big_endian: bool,
    header_bytes: u64,
}

#[derive(Serialize, Deserialize)]
struct Written(#[serde(with = "Form")] RawLayout);

pub(super) fn serialize<S: Serializer>(layout: &Option<RawLayout>, serializer: S) -> Result<S::Ok, S::Error> {
    layout.clone().map(Written).serialize(serializer)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<RawLayout>, D::Error> {
    Ok(Option::<Written>::deserialize(deserializer)?.map(|Written(layout)| layout))
}

fn write_type<S: Serializer>(voxel_type: &VoxelType, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(voxel_type.name())
}

fn read_type<'de, D: Deserializer<'de>>(deserializer: D) -> Result<VoxelType, D::Error> {
    spec::voxel_type(&String::deserialize(deserializer)?).map_err(D::Error::custom)
}
