//! Between which depths a picture in layers has something.

use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use crate::pipeline::KernelFiles;
use crate::target::{Target, target_texture};
use wgpu::util::DeviceExt as _;
use wheatstone_core::view::PixelRect;
use wheatstone_core::warp::WarpError;

/// Side of a tile, pixels: `SIDE` of `warp/depth_tiles.wgsl`.
const SIDE: u32 = 16;

const DEPTH_TILES: KernelFiles<'_> =
    KernelFiles { root: "warp/depth_tiles", choices: &[], entry_point: "find_depths" };
const JOIN_COLUMNS: KernelFiles<'_> =
    KernelFiles { root: "warp/depth_range", choices: &[], entry_point: "join_columns" };
const JOIN_ROW: KernelFiles<'_> =
    KernelFiles { root: "warp/depth_range", choices: &[], entry_point: "join_row" };

/// Every kernel of this pass.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<KernelFiles<'static>> {
    vec![DEPTH_TILES, JOIN_COLUMNS, JOIN_ROW]
}

/// The kernels.
#[derive(Debug)]
pub struct DepthPass {
    tiles: Kernel,
    columns: Kernel,
    row: Kernel,
}

/// Nearest and furthest depth of the layers of a picture, tile by tile and of all: made once per picture, then read by every
/// volumetric warp of it.
#[derive(Debug)]
pub struct LayerDepths {
    size: [u32; 2],
    tiles: wgpu::Texture,
    columns: wgpu::Texture,
    all: wgpu::Texture,
}

impl LayerDepths {
    /// Room for those of pictures of a size.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let [across, down] = size.map(|side| side.div_ceil(SIDE));
        let texture = |label, size| target_texture(gpu, label, wgpu::TextureFormat::Rgba32Float, size, 1);
        let depths = Self {
            size,
            tiles: texture("depth tiles", [across, down]),
            columns: texture("depth columns", [across, 1]),
            all: texture("depth range", [1, 1]),
        };
        gpu.check()?;
        Ok(depths)
    }

    /// The size of the pictures.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Depths from and to of each tile, and of all.
    pub(super) fn views(&self) -> [wgpu::TextureView; 2] {
        [view(&self.tiles), view(&self.all)]
    }
}

impl DepthPass {
    /// Builds the kernels.
    ///
    /// # Errors
    /// A kernel that the driver refuses, a lost device.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |files| Kernel::new(&gpu.device, files);
        let pass =
            Self { tiles: kernel(&DEPTH_TILES)?, columns: kernel(&JOIN_COLUMNS)?, row: kernel(&JOIN_ROW)? };
        gpu.check()?;
        Ok(pass)
    }

    /// Encodes finding the depths of a picture that has just been cast.
    ///
    /// # Errors
    /// A picture without layers or of another size.
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        depths: &LayerDepths,
    ) -> Result<(), WarpError> {
        let layers = target.layers.as_ref().ok_or(WarpError::NoLayers)?;
        if target.size() != depths.size {
            return Err(WarpError::Mismatch { image: target.size(), view: depths.size });
        }
        let PixelRect { columns, rows } = target.drawn_pixels();
        let drawn = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("drawn pixels"),
            contents: bytemuck::cast_slice(&[columns.start, rows.start, columns.end, rows.end]),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let steps: [(_, _, _, &[_]); 3] = [
            (&self.tiles, array_view(layers), &depths.tiles, &[drawn.as_entire_binding()]),
            (&self.columns, view(&depths.tiles), &depths.columns, &[]),
            (&self.row, view(&depths.columns), &depths.all, &[]),
        ];
        for (kernel, from, into, uniforms) in steps {
            let into_view = view(into);
            let textures = [&from, &into_view].map(wgpu::BindingResource::TextureView);
            let group = kernel.bind(&gpu.device, &[&textures[..], uniforms].concat());
            kernel.dispatch(encoder, &group, [into.width(), into.height(), 1]);
        }
        Ok(())
    }
}

fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// All layers of a texture.
pub(super) fn array_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}
