//! Layers: the reference view cast ray by ray, the segments left in layers of the derived view that another pass composites.
//!
//! Single-pass stereo as published (SP Alg. 1–3). Of a derived pixel's depth only the slab is known: it is that of the
//! slab's middle.

use super::pair::{Eye, PairFrame, PairReport};
use super::{LayerFormat, PairError, Quality, Splat};
use crate::cast_pass::VariantPipelines;
use crate::groups::{GroupLayouts, bind, layout};
use crate::pacer::BAND_ROWS;

impl LayerFormat {
    fn texture_format(self) -> wgpu::TextureFormat {
        match self {
            Self::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
            Self::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        }
    }

    fn bytes_per_pixel(self) -> u32 {
        match self {
            Self::Rgba8Unorm => 4,
            Self::Rgba16Float => 8,
        }
    }

    /// The files of the casting kernel's slots.
    fn files(self) -> [(&'static str, &'static str); 2] {
        match self {
            Self::Rgba8Unorm => {
                [("lib/segment_sink", "stereo/sink_layers"), ("lib/layer_target", "stereo/layers_rgba8unorm")]
            }
            Self::Rgba16Float => [
                ("lib/segment_sink", "stereo/sink_layers"),
                ("lib/layer_target", "stereo/layers_rgba16float"),
            ],
        }
    }
}

/// Pipelines for layers of a format, and the layers of the last pair.
#[derive(Debug)]
pub(crate) struct LayerPass {
    format: LayerFormat,
    cast_layout: wgpu::BindGroupLayout,
    cast: VariantPipelines,
    composite_layout: wgpu::BindGroupLayout,
    composite: VariantPipelines,
    layers: Option<wgpu::Texture>,
}

impl LayerPass {
    /// Nothing built yet.
    pub(crate) fn new(
        device: &wgpu::Device,
        groups: &GroupLayouts,
        format: LayerFormat,
        quality: Quality,
    ) -> Self {
        let view_dimension = wgpu::TextureViewDimension::D2Array;
        let written = wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: format.texture_format(),
            view_dimension,
        };
        let read = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension,
            multisampled: false,
        };
        let [cast_layout, composite_layout] =
            [written, read].map(|texture| layout(device, "layers", &[texture]));
        let pipeline_layout = |own| groups.pipeline_layout(device, "layers", Some(own));
        let composite = VariantPipelines::new(
            pipeline_layout(&composite_layout),
            "stereo/composite_layers",
            "composite_layers",
            &[],
        );
        let cast = VariantPipelines::new(
            pipeline_layout(&cast_layout),
            "stereo/cast_layers",
            "cast_layers",
            &[&format.files()[..], &[Splat::of(quality).file()]].concat(),
        );
        Self { format, cast_layout, cast, composite_layout, composite, layers: None }
    }

    /// Makes a pair.
    pub(crate) fn render(&mut self, frame: &PairFrame<'_>) -> Result<PairReport, PairError> {
        let PairFrame { gpu, prepared, slabs, .. } = frame;
        frame.check_whole_rays()?;
        let bytes = slabs.layer_bytes(frame.size(), self.format.bytes_per_pixel());
        let pipeline = self.cast.pipeline(gpu, prepared.variant)?;
        let composite_pipeline = self.composite.pipeline(gpu, prepared.variant)?;
        let layers = self.layers(frame, bytes)?;
        let clear = frame.run(|encoder| {
            encoder.clear_texture(&layers, &wgpu::ImageSubresourceRange::default());
        })?;

        let pair = frame.uniform(BAND_ROWS);
        let view = layers.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let [cast_group, composite_group] = [&self.cast_layout, &self.composite_layout]
            .map(|layout| bind(&gpu.device, layout, &[wgpu::BindingResource::TextureView(&view)]));
        let bindings = frame.bind(Eye::Reference, &pair);
        let cast = frame.run(|encoder| {
            let mut pass = bindings.begin_pass(encoder, &pipeline, Some(&cast_group));
            let [_, bands] = frame.squares(Eye::Reference);
            pass.dispatch_workgroups(pair.count, bands, 1);
        })?;
        let bindings = frame.bind(Eye::Derived, &pair);
        let composite = frame.run(|encoder| {
            let mut pass = bindings.begin_pass(encoder, &composite_pipeline, Some(&composite_group));
            let [squares_x, squares_y] = frame.squares(Eye::Derived);
            pass.dispatch_workgroups(squares_x, squares_y, 1);
        })?;
        Ok(PairReport { bytes, clear, cast, composite, ..PairReport::default() })
    }

    /// Layers for a pair: those of the last pair if they are as many and as large.
    fn layers(&mut self, frame: &PairFrame<'_>, bytes: u64) -> Result<wgpu::Texture, PairError> {
        let PairFrame { gpu, slabs, .. } = frame;
        let [width, height] = frame.size();
        let most_layers = gpu.device.limits().max_texture_array_layers;
        let most_bytes = gpu.capabilities().largest_texture;
        if slabs.layers() > most_layers || bytes > most_bytes {
            return Err(PairError::Layers { layers: slabs.layers(), bytes, most_layers, most_bytes });
        }
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: slabs.layers() };
        if let Some(layers) = self.layers.take().filter(|layers| layers.size() == size) {
            return Ok(self.layers.insert(layers).clone());
        }
        let layers = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("layers"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.format.texture_format(),
            // Not a render target: emptied by copies of zeros, on software Vulkan in half the time of render passes and a
            // tenth of a kernel's.
            usage: wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        gpu.check()?;
        Ok(self.layers.insert(layers).clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;

    #[test]
    fn the_pass_builds_on_the_noop_device() {
        build_on_noop_device(|device| {
            let kinds = [LayerFormat::Rgba8Unorm, LayerFormat::Rgba16Float]
                .map(|format| [Quality::Nearest, Quality::Fast].map(|quality| (format, quality)));
            for (format, quality) in kinds.into_iter().flatten() {
                let pass = LayerPass::new(device, &GroupLayouts::new(device), format, quality);
                [pass.cast, pass.composite].iter().for_each(|pipelines| pipelines.build_all_of_pairs(device));
            }
        });
    }
}
