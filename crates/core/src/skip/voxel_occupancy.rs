//! How much of a volume a transfer function shows, as DM counts it.

use crate::gradient_map::{GradientDepth, GradientMap};
use crate::scene::GradientMethod;
use crate::transfer::TransferFunction;
use crate::volume::{Encoding, StorageKind, StoredVoxels, Volume, Window};
use rayon::prelude::*;

/// The part of the voxels that have an opacity above zero (DM Table 2); gradients are those of a map of 16 bits.
pub fn voxel_occupancy(
    volume: &Volume,
    window: Window,
    transfer: &TransferFunction,
    method: GradientMethod,
) -> f64 {
    let kind = StorageKind::lossless_for(volume);
    let value_is_visible =
        |voxel: usize| transfer.opacity_at(window.normalise(volume.voxels().value(voxel)) as f32) > 0.0;
    let voxels = 0..volume.grid().voxel_count();
    let count = if transfer.is_2d() {
        let map = GradientMap::new(volume, kind, method, GradientDepth::Bits16);
        let (value_scale, _) = Encoding::new(volume, kind).normalised_from_stored(window);
        let (scale, _) = map.normalised_from_code(value_scale);
        let codes = match map.codes() {
            StoredVoxels::U16(codes) => codes,
            StoredVoxels::U8(_) | StoredVoxels::F32(_) => unreachable!("the map has 16 bits"),
        };
        let gradient_is_visible = |voxel: usize| {
            transfer.gradient_opacity_at((f64::from(codes[voxel]) * scale).min(1.0) as f32) > 0.0
        };
        voxels.into_par_iter().filter(|&voxel| value_is_visible(voxel) && gradient_is_visible(voxel)).count()
    } else {
        voxels.into_par_iter().filter(|&voxel| value_is_visible(voxel)).count()
    };
    count as f64 / volume.grid().voxel_count() as f64
}
