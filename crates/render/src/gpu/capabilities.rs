//! Capability tiers, read once when a device is described.

use wheatstone_core::skip::SkipHost;

/// What an adapter offers of the things that Wheatstone can use.
#[derive(Debug, Clone, PartialEq)]
pub struct Capabilities {
    /// 16-bit normalised textures; without them 16-bit volumes are held as half floats.
    pub has_16bit_norm: bool,
    /// Linear filtering of 32-bit float textures; without it float volumes are held at 16 bits.
    pub has_f32_filtering: bool,
    /// Timestamps around passes.
    pub has_timestamps: bool,
    /// Largest side of a 3D texture, voxels.
    pub largest_3d_side: u32,
    /// Largest side of a picture, pixels.
    pub largest_2d_side: u32,
    /// Largest storage buffer binding, bytes.
    pub largest_storage_binding: u64,
    /// Largest texture that the driver is known to take, bytes.
    pub largest_texture: u64,
}

/// How much of Wheatstone an adapter can run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// Everything, with volumes at half-float precision where they exceed 8 bits.
    Basic,
    /// Everything at full precision.
    Full,
}

impl Tier {
    /// Lower-case name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Basic => "basic",
            Self::Full => "full",
        }
    }
}

impl Capabilities {
    pub(super) fn of(adapter: &wgpu::Adapter) -> Self {
        let (features, limits) = (adapter.features(), adapter.limits());
        Self {
            has_16bit_norm: features.contains(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM),
            has_f32_filtering: features.contains(wgpu::Features::FLOAT32_FILTERABLE),
            has_timestamps: features.contains(wgpu::Features::TIMESTAMP_QUERY),
            largest_3d_side: limits.max_texture_dimension_3d,
            largest_2d_side: limits.max_texture_dimension_2d,
            largest_storage_binding: limits.max_storage_buffer_binding_size,
            // Software Vulkan takes just under 2 GiB; nothing reports a limit.
            largest_texture: if adapter.get_info().device_type == wgpu::DeviceType::Cpu {
                (1 << 31) - 1
            } else {
                u64::MAX
            },
        }
    }

    /// The features that are asked for where they exist.
    pub(super) fn wanted_features() -> wgpu::Features {
        wgpu::Features::TEXTURE_FORMAT_16BIT_NORM
            | wgpu::Features::FLOAT32_FILTERABLE
            | wgpu::Features::TIMESTAMP_QUERY
            | wgpu::Features::CLEAR_TEXTURE
    }

    /// How large structures of empty-space skipping may be.
    pub fn skip_host(&self) -> SkipHost {
        let size = |bytes: u64| usize::try_from(bytes).unwrap_or(usize::MAX);
        SkipHost::Gpu {
            largest_side: self.largest_3d_side as usize,
            largest_buffer: size(self.largest_storage_binding),
        }
    }

    /// The tier that these capabilities make.
    pub fn tier(&self) -> Tier {
        if self.has_16bit_norm && self.has_f32_filtering { Tier::Full } else { Tier::Basic }
    }
}
