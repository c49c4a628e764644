//! Images that the runtime shows, as textures to draw to.
//!
//! # Colours
//!
//! Wheatstone's colours are display-referred: they have been encoded for a display, and are composited so. The runtime's compositor
//! works with light. Images therefore are of an sRGB format, which it decodes before it blends and encodes for the display again, and are drawn
//! to through views of the same format without sRGB, which encode nothing: what a pass writes is in the image bit by bit, and an opaque
//! pixel comes out on the display as it was written. A translucent one does over black; over what else is behind it the compositor
//! blends light, where Wheatstone would blend what is encoded.

use crate::error::{Called, XrError};
use openxr as xr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use wgpu::hal::api::Vulkan;
use wgpu::hal::vulkan::TextureMemory;

/// What a swapchain's images hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Content {
    /// Vulkan's number of the format, as the runtime takes it.
    format: u32,
    /// The format of the images' textures.
    texture: wgpu::TextureFormat,
    /// The format of the views that are drawn to.
    view: wgpu::TextureFormat,
}

impl Content {
    /// `VK_FORMAT_R8G8B8A8_SRGB` and `VK_FORMAT_B8G8R8A8_SRGB`.
    const COLORS: [Self; 2] = [
        Self {
            format: 43,
            texture: wgpu::TextureFormat::Rgba8UnormSrgb,
            view: wgpu::TextureFormat::Rgba8Unorm,
        },
        Self {
            format: 50,
            texture: wgpu::TextureFormat::Bgra8UnormSrgb,
            view: wgpu::TextureFormat::Bgra8Unorm,
        },
    ];

    /// `VK_FORMAT_D32_SFLOAT`.
    const DEPTH: Self = Self {
        format: 126,
        texture: wgpu::TextureFormat::Depth32Float,
        view: wgpu::TextureFormat::Depth32Float,
    };

    /// Display-referred colours, of the first of the formats that the runtime likes best.
    pub(crate) fn color(offered: &[u32]) -> Result<Self, XrError> {
        offered
            .iter()
            .find_map(|format| Self::COLORS.into_iter().find(|color| color.format == *format))
            .ok_or_else(|| XrError::NoFormat { offered: format!("{offered:?}") })
    }

    /// Depths, where offered.
    pub(crate) fn depth(offered: &[u32]) -> Option<Self> {
        offered.contains(&Self::DEPTH.format).then_some(Self::DEPTH)
    }

    /// The format of the views that are drawn to.
    pub(crate) fn view_format(self) -> wgpu::TextureFormat {
        self.view
    }

    fn is_depth(self) -> bool {
        self == Self::DEPTH
    }

    /// The state that the runtime hands images out in and wants them back in.
    fn released(self) -> wgpu::TextureUses {
        if self.is_depth() { wgpu::TextureUses::DEPTH_STENCIL_WRITE } else { wgpu::TextureUses::COLOR_TARGET }
    }
}

/// What images are used for beside being drawn to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reading {
    /// Nothing.
    Never,
    /// They are sampled and copied from.
    Sampled,
}

/// How far the use of an image has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Held {
    Nothing,
    /// Acquired, but the runtime may still be reading it.
    Acquired(usize),
    /// To be drawn to.
    Ready(usize),
}

/// A runtime's swapchain and its images.
pub(crate) struct Swapchain {
    handle: Arc<Mutex<xr::Swapchain<xr::Vulkan>>>,
    images: Vec<wgpu::Texture>,
    content: Content,
    size: [u32; 2],
    reading: Reading,
    held: Held,
    has_picture: bool,
}

impl Swapchain {
    /// Makes a swapchain of pictures of a size.
    pub(crate) fn new(
        session: &xr::Session<xr::Vulkan>,
        device: &wgpu::Device,
        content: Content,
        size: [u32; 2],
        reading: Reading,
    ) -> Result<Self, XrError> {
        let handle = session
            .create_swapchain(&xr::SwapchainCreateInfo {
                create_flags: xr::SwapchainCreateFlags::EMPTY,
                usage_flags: runtime_usage(content, reading),
                format: content.format,
                sample_count: 1,
                width: size[0],
                height: size[1],
                face_count: 1,
                array_size: 1,
                mip_count: 1,
            })
            .called("xrCreateSwapchain")?;
        let raw_images = handle.enumerate_images().called("xrEnumerateSwapchainImages")?;
        let handle = Arc::new(Mutex::new(handle));
        let images = raw_images
            .into_iter()
            .map(|image| texture(device, image, content, size, reading, &handle))
            .collect::<Result<_, _>>()?;
        Ok(Self { handle, images, content, size, reading, held: Held::Nothing, has_picture: false })
    }

    /// The format of the views that are drawn to.
    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        self.content.view
    }

    /// Waits for the next image that may be drawn to. It is the same until it is released.
    pub(crate) fn acquire(&mut self) -> Result<wgpu::TextureView, XrError> {
        let mut handle = lock(&self.handle);
        if self.held == Held::Nothing {
            let index = handle.acquire_image().called("xrAcquireSwapchainImage")?;
            self.held = Held::Acquired(index as usize);
        }
        if let Held::Acquired(index) = self.held {
            handle.wait_image(xr::Duration::INFINITE).called("xrWaitSwapchainImage")?;
            self.held = Held::Ready(index);
        }
        drop(handle);
        let image = self.ready().ok_or_else(|| XrError::Refused {
            call: "xrAcquireSwapchainImage",
            reason: format!("no image of the {} there are was handed out", self.images.len()),
        })?;
        Ok(image.create_view(&wgpu::TextureViewDescriptor {
            format: Some(self.content.view),
            ..Default::default()
        }))
    }

    /// Width and height of its pictures, pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The image that is being drawn to.
    fn ready(&self) -> Option<&wgpu::Texture> {
        if let Held::Ready(index) = self.held { self.images.get(index) } else { None }
    }

    /// Whether an image is being drawn to.
    pub(crate) fn is_ready(&self) -> bool {
        self.ready().is_some()
    }

    /// The transition that the image needs before it is released; none if it cannot have been used otherwise.
    pub(crate) fn transition(&self) -> Option<wgpu::TextureTransition<&wgpu::Texture>> {
        let texture = self.ready().filter(|_| self.reading == Reading::Sampled)?;
        Some(wgpu::TextureTransition { texture, selector: None, state: self.content.released() })
    }

    /// Hands the image that is being drawn to, if any, to the runtime. What draws to it has to be submitted.
    pub(crate) fn release(&mut self) -> Result<(), XrError> {
        if let Held::Ready(_) = self.held {
            lock(&self.handle).release_image().called("xrReleaseSwapchainImage")?;
            self.held = Held::Nothing;
            self.has_picture = true;
        }
        Ok(())
    }

    /// Whether a picture was ever released, which layers show.
    pub(crate) fn has_picture(&self) -> bool {
        self.has_picture
    }

    /// All of the picture that was released last, for a layer.
    pub(crate) fn sub_image(&self) -> xr::SwapchainSubImage<'_, xr::Vulkan> {
        let [width, height] = self.size.map(|side| i32::try_from(side).unwrap_or(i32::MAX));
        let image_rect =
            xr::Rect2Di { offset: xr::Offset2Di { x: 0, y: 0 }, extent: xr::Extent2Di { width, height } };
        let swapchain = lock(&self.handle).as_raw();
        let raw = xr::sys::SwapchainSubImage { swapchain, image_rect, image_array_index: 0 };
        // SAFETY: the handle is valid as long as the swapchain, which the result borrows.
        unsafe { xr::SwapchainSubImage::from_raw(raw) }
    }
}

/// A handle is not left in the middle of anything by a panic.
fn lock(handle: &Mutex<xr::Swapchain<xr::Vulkan>>) -> MutexGuard<'_, xr::Swapchain<xr::Vulkan>> {
    handle.lock().unwrap_or_else(PoisonError::into_inner)
}

fn runtime_usage(content: Content, reading: Reading) -> xr::SwapchainUsageFlags {
    use xr::SwapchainUsageFlags as Usage;
    let drawn = if content.is_depth() {
        Usage::DEPTH_STENCIL_ATTACHMENT
    } else {
        Usage::COLOR_ATTACHMENT | Usage::MUTABLE_FORMAT
    };
    match reading {
        Reading::Never => drawn,
        Reading::Sampled => drawn | Usage::SAMPLED | Usage::TRANSFER_SRC,
    }
}

fn texture(
    device: &wgpu::Device,
    image: xr::sys::platform::VkImage,
    content: Content,
    size: [u32; 2],
    reading: Reading,
    handle: &Arc<Mutex<xr::Swapchain<xr::Vulkan>>>,
) -> Result<wgpu::Texture, XrError> {
    use ash::vk::Handle as _;
    let read = match reading {
        Reading::Never => wgpu::TextureUsages::empty(),
        Reading::Sampled => wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING,
    };
    let read_uses = match reading {
        Reading::Never => wgpu::TextureUses::empty(),
        Reading::Sampled => wgpu::TextureUses::COPY_SRC | wgpu::TextureUses::RESOURCE,
    };
    let view_formats = [content.view];
    let view_formats = if content.view == content.texture { &[][..] } else { &view_formats[..] };
    let size = wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 };
    let description = wgpu::TextureDescriptor {
        label: Some("headset"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: content.texture,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | read,
        view_formats,
    };
    let hal_description = wgpu::hal::TextureDescriptor {
        label: description.label,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: content.texture,
        usage: content.released() | read_uses,
        memory_flags: wgpu::hal::MemoryFlags::empty(),
        view_formats: view_formats.to_vec(),
    };
    let keep_swapchain = Arc::clone(handle);
    // SAFETY: nothing of what is handed out is destroyed here.
    let hal = unsafe { device.as_hal::<Vulkan>() }
        .ok_or_else(|| XrError::Vulkan { what: "using the device", reason: "not of Vulkan".to_owned() })?;
    // SAFETY: the image is of the swapchain that was made on this device by the same description; it lives as long as the swapchain, which
    // the callback keeps until the texture is not used any more. Its memory is the runtime's.
    let texture = unsafe {
        hal.texture_from_raw(
            ash::vk::Image::from_raw(image),
            &hal_description,
            Some(Box::new(move || drop(keep_swapchain))),
            TextureMemory::External,
        )
    };
    // SAFETY: made of this device by the same description. Images are handed out by the runtime in the released state, and are drawn to
    // before they are read.
    Ok(unsafe { device.create_texture_from_hal::<Vulkan>(texture, &description, content.released()) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_of_the_runtimes_first_format_that_decodes() {
        let (rgba_linear, rgba, bgra, half) = (37, 43, 50, 97);
        let chosen = Content::color(&[half, rgba_linear, bgra, rgba]).unwrap();
        assert_eq!(chosen.texture, wgpu::TextureFormat::Bgra8UnormSrgb);
        assert_eq!(chosen.texture.remove_srgb_suffix(), chosen.view);
        assert_eq!(
            Content::color(&[half, rgba_linear]),
            Err(XrError::NoFormat { offered: "[97, 37]".to_owned() })
        );
    }

    #[test]
    fn depths_are_floats_where_offered() {
        assert_eq!(
            Content::depth(&[43, 126]).map(Content::view_format),
            Some(wgpu::TextureFormat::Depth32Float)
        );
        assert_eq!(Content::depth(&[43, 124]), None);
    }
}
