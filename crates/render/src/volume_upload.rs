//! A volume on its way to the device: slab by slab, each in as many steps as the time for them asks for.

use crate::gpu::{Gpu, GpuError};
use crate::pace::Pace;
use crate::rows::Rows;
use crate::volume::{GpuVolume, TexelFormat, check_size, voxel_texture};
use std::time::{Duration, Instant};
use wheatstone_core::volume::{Encoding, Volume};

/// Bytes of a slab: what is converted and staged at once.
const SLAB_BYTES: usize = 16 << 20;

/// Bytes of a first step, of which nobody knows how long it takes.
const FIRST_BYTES: usize = 64 << 10;

/// Some slices of a volume as texels.
#[derive(Debug)]
pub struct Slab {
    texels: Vec<u8>,
}

impl Slab {
    /// All slices of a volume as texels of a format, one slab after the other. Each is made when it is asked for, which may be on
    /// another thread than that of the upload.
    pub fn all_of(volume: &Volume, format: TexelFormat) -> impl Iterator<Item = Self> {
        let [width, height, depth] = volume.grid().dims();
        let encoding = Encoding::new(volume, format.storage_kind());
        let slab_depth = (SLAB_BYTES / (width * height * format.byte_size())).max(1);
        (0..depth).step_by(slab_depth).map(move |first| {
            let end = (first + slab_depth).min(depth);
            let voxels = first * width * height..end * width * height;
            Self { texels: format.texels(&encoding.encode(volume.voxels(), voxels), [width, height]) }
        })
    }
}

/// A volume on the device of which not all texels are there yet. Steps are submitted and waited for, so that they are as long as they
/// seem; between them the device is free for other work.
#[derive(Debug)]
pub struct VolumeUpload {
    volume: GpuVolume,
    texture: wgpu::Texture,
    /// What is written next.
    slab: Option<Slab>,
    /// Rows of the slab that are written.
    slab_rows: usize,
    /// Rows of all slices that are written.
    rows: usize,
    /// Counts bytes.
    pace: Pace,
}

impl VolumeUpload {
    /// Makes room for a volume in a given format.
    ///
    /// # Errors
    /// A volume beyond the device's limits, no memory, a lost device.
    pub fn begin(gpu: &Gpu, volume: &Volume, format: TexelFormat) -> Result<Self, GpuError> {
        let dims = volume.grid().dims();
        check_size(gpu.capabilities(), dims, format)?;
        let texture = voxel_texture(gpu, "volume", dims, format.wgpu());
        gpu.check()?;
        Ok(Self {
            volume: GpuVolume::of_texture(&texture, volume, format),
            texture,
            slab: None,
            slab_rows: 0,
            rows: 0,
            pace: Pace::beginning_with(FIRST_BYTES),
        })
    }

    /// Whether all of the last slab is written, and another is to come.
    pub fn wants_slab(&self) -> bool {
        self.slab.is_none() && !self.is_whole()
    }

    /// Takes the next slab of [`Slab::all_of`].
    ///
    /// # Panics
    /// If none is wanted.
    pub fn take(&mut self, slab: Slab) {
        assert!(self.wants_slab(), "slabs are written one after the other");
        (self.slab, self.slab_rows) = (Some(slab), 0);
    }

    /// Writes as much of the slab as a time holds, by what the last steps took: whole slices, or rows of one, but at least a row.
    /// Nothing if there is no slab.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn step(&mut self, gpu: &Gpu, time: Duration) -> Result<(), GpuError> {
        let Some(Slab { texels }) = &self.slab else { return Ok(()) };
        let begun = Instant::now();
        let [width, height, _] = self.volume.dims;
        let row_bytes = width * self.volume.format().byte_size();
        let left = texels.len() / row_bytes - self.slab_rows;
        let part = Rows::next(height, self.rows, (self.pace.fitting(time) / row_bytes).min(left), 1);
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &self.texture,
                mip_level: 0,
                origin: part.origin(),
                aspect: wgpu::TextureAspect::All,
            },
            &texels[self.slab_rows * row_bytes..][..part.count() * row_bytes],
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes as u32),
                rows_per_image: Some(part.rows.len() as u32),
            },
            part.extent(width),
        );
        let submission = gpu.queue.submit([]);
        gpu.wait_for(submission)?;
        self.pace.learn(part.count() * row_bytes, begun.elapsed());
        self.rows += part.count();
        self.slab_rows += part.count();
        if part.count() == left {
            self.slab = None;
        }
        Ok(())
    }

    /// Slices that are written, and all that there are.
    pub fn slices(&self) -> (usize, usize) {
        let [_, height, depth] = self.volume.dims;
        (self.rows / height, depth)
    }

    /// Whether all slices are written.
    pub fn is_whole(&self) -> bool {
        let (done, all) = self.slices();
        done == all
    }

    /// The volume.
    ///
    /// # Panics
    /// If slices are missing.
    pub fn finish(self) -> GpuVolume {
        assert!(self.is_whole(), "{:?} slices are written", self.slices());
        self.volume
    }
}
