//! Where a view is cast to: colour, depth and sample counts of one picture, and their way back to the host.

use crate::anchors::GpuSlabs;
use crate::first_hits::GpuFirstHits;
use crate::gpu::{Gpu, GpuError};
use crate::readback::read_texture;
use crate::squares::Squares;
use wheatstone_core::first_hits::FirstHits;
use wheatstone_core::image::Image;
use wheatstone_core::reference::{Cast, Reads};
use wheatstone_core::view::PixelRect;

/// Bytes of a pixel of either texture.
const PIXEL_BYTES: u32 = 16;

/// Layers of emission and absorption per pixel: as many as fit the vectors of shaders.
pub const LAYERS: u32 = 4;

/// Zeros that are copied at once: more than the longest row of a picture.
const ZERO_BYTES: u64 = 1 << 20;

/// Checks that a device can hold a picture.
///
/// # Errors
/// [`GpuError::PictureSize`] for an empty or too large one.
pub(crate) fn check_size([width, height]: [u32; 2], largest_side: u32) -> Result<(), GpuError> {
    let allowed = 1..=largest_side;
    if allowed.contains(&width) && allowed.contains(&height) {
        Ok(())
    } else {
        Err(GpuError::PictureSize { width, height, allowed: largest_side })
    }
}

/// Textures of one picture on the device.
#[derive(Debug)]
pub struct Target {
    size: [u32; 2],
    /// RGBA, premultiplied, 32-bit float.
    pub(crate) color: wgpu::Texture,
    /// Depth of the first hit in metres, samples taken, reads of the skip map, 1 where something was hit; 32-bit float.
    pub(crate) depth: wgpu::Texture,
    /// What rays pass through, in the format of `lib/layer_words.wgsl`, if casts are to keep that.
    pub(crate) layers: Option<wgpu::Texture>,
    /// What the picture saw first and where its rays started, if casts are to leap.
    pub(crate) first_hits: Option<GpuFirstHits>,
    /// What rays pass in slabs of depth, if casts are to keep that.
    pub(crate) slabs: Option<GpuSlabs>,
    /// What is not blank at most.
    pub(crate) drawn: Squares,
}

impl Target {
    /// Format of the colours: premultiplied.
    pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

    /// Makes the textures of a picture.
    ///
    /// # Errors
    /// [`GpuError::PictureSize`] for an empty or too large picture, no memory, a lost device.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        check_size(size, gpu.capabilities().largest_2d_side)?;
        let [color, depth] = ["color target", "depth target"]
            .map(|label| target_texture(gpu, label, Self::COLOR_FORMAT, size, 1));
        gpu.check()?;
        Ok(Self {
            size,
            color,
            depth,
            layers: None,
            first_hits: None,
            slabs: None,
            drawn: Squares::default(),
        })
    }

    /// The same with room for the layers of emission and absorption that casts prepared for them keep.
    ///
    /// # Errors
    /// As [`Target::new`].
    pub fn with_layers(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let target = Self::new(gpu, size)?;
        Ok(Self { layers: Some(layer_texture(gpu, size)?), ..target })
    }

    /// The same with room for what casts that leap to first hits note ([`Renderer::leaping`](crate::Renderer::leaping)).
    ///
    /// # Errors
    /// As [`Target::new`].
    pub fn with_first_hits(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let target = Self::new(gpu, size)?;
        let first_hits = Some(GpuFirstHits::new(gpu, size));
        gpu.check()?;
        Ok(Self { first_hits, ..target })
    }

    /// The buffer of zeros that [`Target::blank`] copies.
    pub(crate) fn zeros(gpu: &Gpu) -> wgpu::Buffer {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("zeros"),
            size: ZERO_BYTES,
            usage: wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        })
    }

    /// Encodes the emptying of what has been drawn (nothing hit, no samples), before other squares are drawn.
    ///
    /// Copies zeros: on software Vulkan in half the time of a render pass and a tenth of a kernel's.
    pub(crate) fn blank(&mut self, encoder: &mut wgpu::CommandEncoder, zeros: &wgpu::Buffer, next: &Squares) {
        let drawn = std::mem::replace(&mut self.drawn, next.clone());
        self.blank_squares(encoder, zeros, &drawn);
    }

    /// Encodes the emptying of some squares.
    pub(crate) fn blank_squares(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        zeros: &wgpu::Buffer,
        drawn: &Squares,
    ) {
        for texture in [&self.color, &self.depth] {
            blank_squares(encoder, zeros, (texture, 0), drawn);
        }
        if let Some(layers) = &self.layers {
            blank_layers(encoder, zeros, layers, drawn);
        }
    }

    /// The pixels that may not be blank.
    pub(crate) fn drawn_pixels(&self) -> PixelRect {
        self.drawn.pixels(self.size)
    }

    /// Encodes a copy of what has been drawn to another target of the same size.
    pub(crate) fn copy_drawn(&self, encoder: &mut wgpu::CommandEncoder, to: &Self) {
        let drawn = self.drawn_pixels();
        if drawn.is_empty() {
            return;
        }
        let PixelRect { columns, rows } = drawn;
        let origin = wgpu::Origin3d { x: columns.start, y: rows.start, z: 0 };
        for (from, to) in [(&self.color, &to.color), (&self.depth, &to.depth)] {
            encoder.copy_texture_to_texture(
                wgpu::TexelCopyTextureInfo { origin, ..from.as_image_copy() },
                wgpu::TexelCopyTextureInfo { origin, ..to.as_image_copy() },
                wgpu::Extent3d {
                    width: columns.len() as u32,
                    height: rows.len() as u32,
                    depth_or_array_layers: 1,
                },
            );
        }
    }

    /// The colours on the device, for passes that load them: premultiplied, 32-bit floats.
    pub fn color_view(&self) -> wgpu::TextureView {
        self.color.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Reads back what the picture saw first, and where the rays of each tile started, metres; nothing if it was not cast so.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read_first_hits(&self, gpu: &Gpu) -> Result<Option<(FirstHits, Vec<f32>)>, GpuError> {
        let Some(hits) = &self.first_hits else { return Ok(None) };
        let Some(seen) = hits.read(gpu)? else { return Ok(None) };
        Ok(Some((seen, hits.read_starts(gpu)?)))
    }

    /// Reads the picture back.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read(&self, gpu: &Gpu) -> Result<Cast, GpuError> {
        let color: Vec<[f32; 4]> = read_texture(gpu, &self.color)?;
        let depth_and_counts: Vec<[f32; 4]> = read_texture(gpu, &self.depth)?;
        let depth_m = depth_and_counts
            .iter()
            .map(|&[depth_m, .., is_hit]| if is_hit == 0.0 { f32::INFINITY } else { depth_m })
            .collect();
        let reads = depth_and_counts
            .iter()
            .map(|&[_, samples, map_reads, _]| Reads { samples: samples as u32, map_reads: map_reads as u32 })
            .collect();
        let [width, height] = self.size;
        Ok(Cast::new(Image { width, height, color, depth_m }, reads))
    }
}

/// Bytes of the layers of a picture.
pub(crate) fn layer_bytes([width, height]: [u32; 2]) -> u64 {
    u64::from(PIXEL_BYTES * LAYERS) * u64::from(width) * u64::from(height)
}

/// Room for the layers of a picture.
///
/// # Errors
/// More than a texture holds, no memory, a lost device.
pub(crate) fn layer_texture(gpu: &Gpu, size: [u32; 2]) -> Result<wgpu::Texture, GpuError> {
    let (bytes, largest) = (layer_bytes(size), gpu.capabilities().largest_texture);
    if bytes > largest {
        return Err(GpuError::Refused {
            reason: format!("{bytes} bytes of layers; a texture holds {largest}"),
        });
    }
    let layers = target_texture(gpu, "layers", wgpu::TextureFormat::Rgba32Uint, size, LAYERS);
    gpu.check()?;
    Ok(layers)
}

/// Encodes the emptying of some squares of all layers of a picture.
pub(crate) fn blank_layers(
    encoder: &mut wgpu::CommandEncoder,
    zeros: &wgpu::Buffer,
    layers: &wgpu::Texture,
    drawn: &Squares,
) {
    for z in 0..LAYERS {
        blank_squares(encoder, zeros, (layers, z), drawn);
    }
}

/// Encodes the emptying of some squares of a layer of a texture.
fn blank_squares(
    encoder: &mut wgpu::CommandEncoder,
    zeros: &wgpu::Buffer,
    (texture, z): (&wgpu::Texture, u32),
    drawn: &Squares,
) {
    let PixelRect { columns, rows } = drawn.pixels([texture.width(), texture.height()]);
    if columns.is_empty() {
        return;
    }
    let row_bytes = columns.len() as u32 * PIXEL_BYTES;
    let padded_row_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let rows_at_once = ZERO_BYTES as u32 / padded_row_bytes;
    for first_row in rows.clone().step_by(rows_at_once as usize) {
        encoder.copy_buffer_to_texture(
            wgpu::TexelCopyBufferInfo {
                buffer: zeros,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row_bytes),
                    rows_per_image: None,
                },
            },
            wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x: columns.start, y: first_row, z },
                ..texture.as_image_copy()
            },
            wgpu::Extent3d {
                width: columns.len() as u32,
                height: rows_at_once.min(rows.end - first_row),
                depth_or_array_layers: 1,
            },
        );
    }
}

/// A texture that casts write, warps render to and later passes read.
pub(crate) fn target_texture(
    gpu: &Gpu,
    label: &str,
    format: wgpu::TextureFormat,
    [width, height]: [u32; 2],
    layers: u32,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}
