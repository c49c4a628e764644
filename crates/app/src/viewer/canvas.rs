//! What is drawn on: a window, or a texture that stands in for one.

use crate::failure::Failure;
use anyhow::anyhow;
use wheatstone_core::image::RgbImage;
use wheatstone_render::{Gpu, GpuError};

/// Formats of what is drawn on, the best first: colours are display-referred already, so none that converts them.
const FORMATS: [wgpu::TextureFormat; 2] = [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Bgra8Unorm];

/// A surface of a window, or nothing but a size.
pub(crate) enum Canvas {
    Window {
        surface: wgpu::Surface<'static>,
        config: wgpu::SurfaceConfiguration,
        /// Whether the surface has the configuration.
        is_configured: bool,
    },
    Offscreen {
        texture: wgpu::Texture,
    },
}

/// What one refresh is drawn on.
pub(crate) enum Sheet {
    Window(wgpu::SurfaceTexture),
    Offscreen(wgpu::TextureView),
}

impl Sheet {
    pub(crate) fn view(&self) -> wgpu::TextureView {
        match self {
            Self::Window(texture) => texture.texture.create_view(&wgpu::TextureViewDescriptor::default()),
            Self::Offscreen(view) => view.clone(),
        }
    }
}

impl Canvas {
    /// The surface of a window of some pixels.
    pub(crate) fn of_window(
        gpu: &Gpu,
        surface: wgpu::Surface<'static>,
        [width, height]: [u32; 2],
        present_mode: wgpu::PresentMode,
    ) -> Result<Self, Failure> {
        let mut config = surface
            .get_default_config(gpu.adapter(), width.max(1), height.max(1))
            .ok_or_else(|| anyhow!("the adapter {} cannot show a window", gpu.description().name))?;
        let offered = surface.get_capabilities(gpu.adapter()).formats;
        let format = FORMATS.into_iter().find(|format| offered.contains(format));
        config.format = format.ok_or_else(|| anyhow!("the window takes none of the formats {FORMATS:?}"))?;
        config.present_mode = present_mode;
        config.desired_maximum_frame_latency = 1;
        Ok(Self::Window { surface, config, is_configured: false })
    }

    /// A texture in the place of a window.
    pub(crate) fn offscreen(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        Ok(Self::Offscreen { texture: texture(gpu, size, FORMATS[0])? })
    }

    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        match self {
            Self::Window { config, .. } => config.format,
            Self::Offscreen { texture } => texture.format(),
        }
    }

    /// Width and height, pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        match self {
            Self::Window { config, .. } => [config.width, config.height],
            Self::Offscreen { texture } => [texture.width(), texture.height()],
        }
    }

    /// Follows a change of the window's size; a window without area keeps its last one.
    pub(crate) fn resize(&mut self, gpu: &Gpu, [width, height]: [u32; 2]) -> Result<(), GpuError> {
        let largest = gpu.capabilities().largest_2d_side;
        let size = [width.min(largest), height.min(largest)];
        if size.contains(&0) || size == self.size() {
            return Ok(());
        }
        match self {
            Self::Window { config, is_configured, .. } => {
                [config.width, config.height] = size;
                *is_configured = false;
            }
            Self::Offscreen { texture: old } => *old = texture(gpu, size, FORMATS[0])?,
        }
        gpu.check()
    }

    /// A sheet to draw on; none where the window cannot be drawn on just now.
    pub(crate) fn sheet(&mut self, gpu: &Gpu) -> Option<Sheet> {
        if let Self::Window { surface, config, is_configured } = self
            && !*is_configured
        {
            *is_configured = configure(gpu, surface, config);
        }
        match self {
            Self::Offscreen { texture } => {
                Some(Sheet::Offscreen(texture.create_view(&wgpu::TextureViewDescriptor::default())))
            }
            Self::Window { is_configured: false, .. } => None,
            Self::Window { surface, is_configured, .. } => match surface.get_current_texture() {
                wgpu::CurrentSurfaceTexture::Success(texture)
                | wgpu::CurrentSurfaceTexture::Suboptimal(texture) => Some(Sheet::Window(texture)),
                wgpu::CurrentSurfaceTexture::Outdated | wgpu::CurrentSurfaceTexture::Lost => {
                    *is_configured = false;
                    None
                }
                _ => None,
            },
        }
    }
}

/// Configures a surface; whether that was possible. It is not while another thread gives the device work.
fn configure(gpu: &Gpu, surface: &wgpu::Surface<'_>, config: &wgpu::SurfaceConfiguration) -> bool {
    let scope = gpu.device().push_error_scope(wgpu::ErrorFilter::Validation);
    surface.configure(gpu.device(), config);
    pollster::block_on(scope.pop()).is_none()
}

/// A texture that can be drawn on and read.
pub(crate) fn texture(
    gpu: &Gpu,
    size: [u32; 2],
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
    texture_for(gpu, "offscreen", size, format, usage)
}

/// A texture for some uses.
pub(crate) fn texture_for(
    gpu: &Gpu,
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> Result<wgpu::Texture, GpuError> {
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    gpu.check()?;
    Ok(texture)
}

/// Reads a texture of one of the canvas's formats; waits for the device.
pub(crate) fn read_texture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbImage, Failure> {
    let texels: Vec<[u8; 4]> = gpu.read_texture(texture)?;
    let is_blue_first = texture.format() == wgpu::TextureFormat::Bgra8Unorm;
    let rgb = |&[a, b, c, _]: &[u8; 4]| {
        let rgb = if is_blue_first { [c, b, a] } else { [a, b, c] };
        rgb.map(|channel| f32::from(channel) / 255.0)
    };
    let rgb = texels.iter().map(rgb).collect();
    Ok(RgbImage { width: texture.width(), height: texture.height(), rgb })
}
