//! Volumes as 3D textures, and what their texels are.

use crate::gpu::{Capabilities, Gpu, GpuError};
use crate::readback::read_texture;
use crate::volume_upload::{Slab, VolumeUpload};
use half::f16;
use std::time::Duration;
use wheatstone_core::skip::RangeCodes;
use wheatstone_core::volume::{Encoding, StorageKind, StoredVoxels, Volume, Window};

/// How far rounding may carry a number interpolated between half floats of 16-bit numbers, those numbers' units: three f32
/// interpolations, each off by at most 1½ ulp.
const HALF_FLOAT_ROUNDING: f32 = 8.0 * f32::EPSILON * 65535.0;

/// Texel formats that volumes are held in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TexelFormat {
    /// 8-bit normalised.
    R8Unorm,
    /// 16-bit normalised.
    R16Unorm,
    /// Half float that holds 8-bit numbers as they are.
    R16FloatOf8Bit,
    /// Four neighbouring 8-bit voxels in a texel, filtered by the kernel (`lib/quads.wgsl`).
    Rgba8UnormQuads,
    /// Half float that holds 16-bit numbers over 65535.
    R16FloatOf16Bit,
    /// 32-bit float.
    R32Float,
}

impl TexelFormat {
    /// The format for a volume on a device: that of [`TexelFormat::choose`], or quads for 8-bit volumes on software
    /// devices, which read them fastest, if the device has room for such a texture.
    pub fn for_volume(volume: &Volume, kind: StorageKind, gpu: &Gpu) -> Self {
        let has_room = || check_size(gpu.capabilities(), volume.grid().dims(), Self::Rgba8UnormQuads).is_ok();
        if kind == StorageKind::U8 && gpu.description().is_software && has_room() {
            Self::Rgba8UnormQuads
        } else {
            Self::choose(kind, gpu.capabilities(), gpu.description().is_software)
        }
    }

    /// The format with one filterable texel per voxel for a precision on a device. Software devices filter 8-bit texels
    /// in 8-bit arithmetic, so they get half floats, which hold the same numbers exactly.
    pub fn choose(kind: StorageKind, capabilities: &Capabilities, is_software: bool) -> Self {
        match kind {
            StorageKind::U8 if is_software => Self::R16FloatOf8Bit,
            StorageKind::U8 => Self::R8Unorm,
            StorageKind::F32 if capabilities.has_f32_filtering => Self::R32Float,
            StorageKind::U16 | StorageKind::F32 if capabilities.has_16bit_norm => Self::R16Unorm,
            StorageKind::U16 | StorageKind::F32 => Self::R16FloatOf16Bit,
        }
    }

    /// Bytes per voxel.
    pub fn byte_size(self) -> usize {
        match self {
            Self::R8Unorm => 1,
            Self::R16Unorm | Self::R16FloatOf8Bit | Self::R16FloatOf16Bit => 2,
            Self::R32Float | Self::Rgba8UnormQuads => 4,
        }
    }

    pub(crate) fn wgpu(self) -> wgpu::TextureFormat {
        match self {
            Self::R8Unorm => wgpu::TextureFormat::R8Unorm,
            Self::R16Unorm => wgpu::TextureFormat::R16Unorm,
            Self::R16FloatOf8Bit | Self::R16FloatOf16Bit => wgpu::TextureFormat::R16Float,
            Self::Rgba8UnormQuads => wgpu::TextureFormat::Rgba8Unorm,
            Self::R32Float => wgpu::TextureFormat::R32Float,
        }
    }

    pub(crate) fn storage_kind(self) -> StorageKind {
        match self {
            Self::R8Unorm | Self::R16FloatOf8Bit | Self::Rgba8UnormQuads => StorageKind::U8,
            Self::R16Unorm | Self::R16FloatOf16Bit => StorageKind::U16,
            Self::R32Float => StorageKind::F32,
        }
    }

    /// Stored number of a sampled one.
    pub(crate) fn stored_per_sampled(self) -> f64 {
        match self {
            Self::R8Unorm | Self::Rgba8UnormQuads => 255.0,
            Self::R16Unorm | Self::R16FloatOf16Bit => 65535.0,
            Self::R16FloatOf8Bit | Self::R32Float => 1.0,
        }
    }

    /// The codes of a volume's block ranges. Half floats of 16-bit numbers are no whole numbers.
    fn range_codes(self, volume: &Volume) -> RangeCodes {
        let codes = RangeCodes::of_values(volume, self.storage_kind());
        match self {
            Self::R16FloatOf16Bit => RangeCodes { rounding: HALF_FLOAT_ROUNDING, ..codes },
            _ => codes,
        }
    }

    /// Texels of whole slices of `width` × `height` voxels.
    pub(crate) fn texels(self, stored: &StoredVoxels, [width, height]: [usize; 2]) -> Vec<u8> {
        let halves = |numbers: &mut dyn Iterator<Item = f32>| {
            bytemuck::cast_slice(&numbers.map(f16::from_f32).collect::<Vec<f16>>()).to_vec()
        };
        match (self, stored) {
            (Self::R16FloatOf8Bit, StoredVoxels::U8(v)) => {
                let half_of = std::array::from_fn::<f16, 256, _>(|i| f16::from_f32(i as f32));
                bytemuck::cast_slice(&v.iter().map(|&x| half_of[usize::from(x)]).collect::<Vec<f16>>())
                    .to_vec()
            }
            (Self::R16FloatOf16Bit, StoredVoxels::U16(v)) => {
                halves(&mut v.iter().map(|&x| f32::from(x) / 65535.0))
            }
            (Self::Rgba8UnormQuads, StoredVoxels::U8(v)) => quads(v, [width, height]),
            (_, StoredVoxels::U8(v)) => v.clone(),
            (_, StoredVoxels::U16(v)) => bytemuck::cast_slice(v).to_vec(),
            (_, StoredVoxels::F32(v)) => bytemuck::cast_slice(v).to_vec(),
        }
    }
}

/// A volume on the device.
#[derive(Debug)]
pub struct GpuVolume {
    pub(crate) texture: wgpu::TextureView,
    pub(crate) dims: [usize; 3],
    /// Distance of neighbouring voxels along each axis, voxel lengths.
    pub(crate) spacing: [f32; 3],
    pub(crate) range_codes: RangeCodes,
    /// Largest stored number less the smallest.
    pub(crate) stored_range: f32,
    format: TexelFormat,
    encoding: Encoding,
}

impl GpuVolume {
    /// Uploads a volume at the precision that loses nothing, as far as the device has it. `progress` is called
    /// with the slices done and their total.
    ///
    /// # Errors
    /// A volume beyond the device's limits, no memory, a lost device.
    pub fn upload(
        gpu: &Gpu,
        volume: &Volume,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, GpuError> {
        let kind = StorageKind::lossless_for(volume);
        let format = TexelFormat::for_volume(volume, kind, gpu);
        Self::upload_as(gpu, volume, format, progress)
    }

    /// Uploads a volume in a given format.
    ///
    /// # Errors
    /// As [`GpuVolume::upload`].
    pub fn upload_as(
        gpu: &Gpu,
        volume: &Volume,
        format: TexelFormat,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, GpuError> {
        let mut upload = VolumeUpload::begin(gpu, volume, format)?;
        for slab in Slab::all_of(volume, format) {
            upload.take(slab);
            while !upload.is_whole() && !upload.wants_slab() {
                upload.step(gpu, Duration::MAX)?;
            }
            let (done, all) = upload.slices();
            progress(done, all);
        }
        Ok(upload.finish())
    }

    /// What a texture holds once all texels of a volume are in it.
    pub(crate) fn of_texture(texture: &wgpu::Texture, volume: &Volume, format: TexelFormat) -> Self {
        let encoding = Encoding::new(volume, format.storage_kind());
        let (grid, (lo, hi)) = (volume.grid(), volume.range());
        Self {
            texture: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            dims: grid.dims(),
            spacing: (grid.spacing_mm() / grid.voxel_length_mm()).as_vec3().to_array(),
            range_codes: format.range_codes(volume),
            stored_range: (encoding.stored(hi) - encoding.stored(lo)) as f32,
            format,
            encoding,
        }
    }

    /// Reads the texels back, slice by slice and row by row.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, GpuError> {
        let texture = self.texture.texture();
        match self.format.byte_size() {
            1 => read_texture(gpu, texture),
            2 => Ok(bytemuck::cast_slice(&read_texture::<u16>(gpu, texture)?).to_vec()),
            _ => Ok(bytemuck::cast_slice(&read_texture::<u32>(gpu, texture)?).to_vec()),
        }
    }

    /// Voxels along each axis.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// How the voxels are held.
    pub fn format(&self) -> TexelFormat {
        self.format
    }

    /// Bytes on the device.
    pub fn byte_size(&self) -> u64 {
        byte_size(self.dims, self.format)
    }

    /// How values become stored numbers.
    pub(crate) fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// Scale and offset from a sampled number to the normalised value.
    pub(crate) fn normalised_from_sampled(&self, window: Window) -> (f64, f64) {
        let (scale, offset) = self.encoding.normalised_from_stored(window);
        (scale * self.format.stored_per_sampled(), offset)
    }
}

/// Each voxel of whole slices with its neighbours along x, y and both, repeated at the faces.
fn quads(voxels: &[u8], [width, height]: [usize; 2]) -> Vec<u8> {
    let mut quads = vec![0; 4 * voxels.len()];
    let slices = voxels.chunks_exact(width * height).zip(quads.chunks_exact_mut(4 * width * height));
    for (slice, quads) in slices {
        for (y, quads) in quads.chunks_exact_mut(4 * width).enumerate() {
            let row = &slice[y * width..][..width];
            let next = &slice[(y + 1).min(height - 1) * width..][..width];
            let (inner, last) = quads.split_at_mut(4 * (width - 1));
            let pairs = row.windows(2).zip(next.windows(2));
            for (quad, (near, far)) in inner.chunks_exact_mut(4).zip(pairs) {
                quad.copy_from_slice(&[near[0], near[1], far[0], far[1]]);
            }
            let (near, far) = (row[width - 1], next[width - 1]);
            last.copy_from_slice(&[near, near, far, far]);
        }
    }
    quads
}

pub(crate) fn byte_size(dims: [usize; 3], format: TexelFormat) -> u64 {
    dims.iter().map(|&side| side as u64).product::<u64>() * format.byte_size() as u64
}

pub(crate) fn check_size(
    capabilities: &Capabilities,
    dims: [usize; 3],
    format: TexelFormat,
) -> Result<(), GpuError> {
    let largest_side = dims.into_iter().max().unwrap_or(0);
    let bytes = byte_size(dims, format);
    if largest_side <= capabilities.largest_3d_side as usize && bytes <= capabilities.largest_texture {
        return Ok(());
    }
    Err(GpuError::VolumeTooLarge {
        dims,
        bytes,
        largest_side,
        allowed_bytes: capabilities.largest_texture,
        allowed_side: capabilities.largest_3d_side,
    })
}

/// A texture of voxels or blocks that is written, sampled and read back. The caller checks sizes and the device.
pub(crate) fn voxel_texture(
    gpu: &Gpu,
    label: &str,
    dims: [usize; 3],
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(dims),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_DST
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

pub(crate) fn extent([width, height, depth]: [usize; 3]) -> wgpu::Extent3d {
    wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: depth as u32 }
}
