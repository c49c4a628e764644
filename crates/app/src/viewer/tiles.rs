//! The views of a light-field display: kept side by side on the device, and drawn into an area of the window.

use super::show::Area;
use super::state::{Arrangement, Grid, LightField};
use crate::failure::Failure;
use std::collections::HashMap;
use wgpu::util::DeviceExt as _;
use wheatstone_core::lightfield::Lenticular;
use wheatstone_core::lightfield::simulator::SeenView;
use wheatstone_render::Gpu;
use wheatstone_render::live::Front;

/// Of kept views: what a display shows, and what is interpolated fastest.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Of the views that a panel's sub-pixels show.
const SHOWN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Uint;

/// What `tiles.wgsl` reads.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct TilesUniform {
    background: [f32; 3],
    views: u32,
    area: [f32; 4],
    tile: [u32; 2],
    grid: [u32; 2],
    panel: [u32; 2],
    begins_below: u32,
    flips: [u32; 2],
    padding: [u32; 3],
}

/// What `tiles.wgsl` reads of a view that is seen in a column.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SeenUniform {
    view: u32,
    weight: f32,
    along: f32,
    top: f32,
    bottom: f32,
}

impl From<&SeenView> for SeenUniform {
    fn from(seen: &SeenView) -> Self {
        let [top, bottom] = seen.down.map(|share| share as f32);
        Self { view: seen.index as u32, weight: seen.weight as f32, along: seen.along as f32, top, bottom }
    }
}

/// Pipelines, and what is kept between refreshes.
pub(crate) struct Tiles {
    passes: Passes,
    kept: Option<Kept>,
    columns: Option<Columns>,
    panel: Option<Panel>,
    /// Stands in for a panel where none is shown.
    no_panel: wgpu::TextureView,
}

struct Passes {
    keep_layout: wgpu::BindGroupLayout,
    keep: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    pipelines: HashMap<Arrangement, wgpu::RenderPipeline>,
    sampler: wgpu::Sampler,
}

/// The views of a picture, one in each layer.
struct Kept {
    /// Counts the pictures that have been cast.
    picture: u64,
    texture: wgpu::Texture,
}

/// What an eye sees in each column, on the device.
struct Columns {
    light_field: LightField,
    size: [u32; 2],
    starts: wgpu::Buffer,
    seen: wgpu::Buffer,
}

/// Which views the sub-pixels of a panel show, on the device.
struct Panel {
    lenses: Lenticular,
    views: u32,
    shown: wgpu::TextureView,
}

/// How views are to be drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HowTiles<'a> {
    pub(crate) arrangement: Arrangement,
    /// In the window, pixels.
    pub(crate) area: Area,
    pub(crate) background: [f32; 3],
    pub(crate) light_field: &'a LightField,
}

impl HowTiles<'_> {
    /// The part of the area that the picture takes: in its middle, as large as fits; pixel by pixel from the top left for a panel.
    fn picture(&self) -> Area {
        let Area { left, top, width, height } = self.area;
        match self.arrangement {
            Arrangement::Quilt => {
                let Grid { columns, rows, .. } = self.light_field.grid();
                let [tile_width, tile_height] = self.light_field.tile_size_beside(self.area.size());
                self.middle([columns * tile_width, rows * tile_height])
            }
            Arrangement::Panel => {
                let [of_panel, below] = self.light_field.lenses().map_or([0; 2], |lenses| lenses.panel_px);
                Area { left, top, width: width.min(of_panel), height: height.min(below) }
            }
            _ => {
                let [width_m, height_m] = self.light_field.screen_size_m();
                let pixels_per_m = (f64::from(width) / width_m).min(f64::from(height) / height_m);
                self.middle([width_m, height_m].map(|metres| (metres * pixels_per_m).round() as u32))
            }
        }
    }

    fn middle(&self, size: [u32; 2]) -> Area {
        let Area { left, top, width, height } = self.area;
        let [within_width, within_height] = [size[0].min(width), size[1].min(height)];
        Area {
            left: left + (width - within_width) / 2,
            top: top + (height - within_height) / 2,
            width: within_width,
            height: within_height,
        }
    }
}

impl Tiles {
    /// Draws on what has a format.
    pub(crate) fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Self, Failure> {
        let no_panel = shown_texture(gpu.device(), [1, 1]);
        let tiles = Self {
            passes: Passes::new(gpu.device(), format),
            kept: None,
            columns: None,
            panel: None,
            no_panel: no_panel.create_view(&wgpu::TextureViewDescriptor::default()),
        };
        gpu.check()?;
        Ok(tiles)
    }

    /// Keeps the views of a display's newest whole picture, the `picture`th that has been cast; whether there is one of all its views.
    /// One of something else changes nothing.
    pub(crate) fn keep(
        &mut self,
        gpu: &Gpu,
        front: &Front,
        picture: u64,
        light_field: &LightField,
    ) -> Result<bool, Failure> {
        let views = light_field.view_count();
        if front.pictures().count() != views as usize {
            return Ok(self.kept.as_ref().is_some_and(|kept| kept.texture.depth_or_array_layers() == views));
        }
        if self.kept.as_ref().is_some_and(|kept| kept.picture == picture) {
            return Ok(true);
        }
        let size = front.pictures().next().map_or([1; 2], |(target, _)| target.size());
        let texture = match self.kept.take().map(|kept| kept.texture) {
            Some(texture)
                if [texture.width(), texture.height()] == size
                    && texture.depth_or_array_layers() == views =>
            {
                texture
            }
            _ => layers(gpu.device(), size, views),
        };
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (layer, (target, _)) in (0..).zip(front.pictures()) {
            self.passes.keep(gpu.device(), &mut encoder, &target.color_view(), &texture, layer);
        }
        gpu.queue().submit([encoder.finish()]);
        gpu.check()?;
        self.kept = Some(Kept { picture, texture });
        Ok(true)
    }

    /// Makes what a picture takes besides the views.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, how: &HowTiles<'_>) -> Result<(), Failure> {
        let size = how.picture().size();
        let is_made = |columns: &Columns| columns.size == size && columns.light_field == *how.light_field;
        if how.arrangement == Arrangement::LightField && !self.columns.as_ref().is_some_and(is_made) {
            self.columns = Some(Columns::new(gpu.device(), how.light_field, size)?);
        }
        if let (Arrangement::Panel, Some(lenses)) = (how.arrangement, how.light_field.lenses()) {
            let views = how.light_field.view_count();
            let is_made = |panel: &Panel| panel.views == views && panel.lenses == *lenses;
            if !self.panel.as_ref().is_some_and(is_made) {
                self.panel = Some(Panel::new(gpu, lenses, views)?);
            }
        }
        Ok(gpu.check()?)
    }

    /// Draws the kept views as they were prepared to be.
    pub(crate) fn draw(&self, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>, how: &HowTiles<'_>) {
        let area = how.picture();
        let (Some(kept), Some(pipeline)) = (&self.kept, self.passes.pipelines.get(&how.arrangement)) else {
            return;
        };
        if area.width == 0 || area.height == 0 {
            return;
        }
        let device = gpu.device();
        let group = self.group(device, kept, &self.uniform(kept, how, area));
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_scissor_rect(area.left, area.top, area.width, area.height);
        pass.draw(0..3, 0..1);
    }

    fn uniform(&self, kept: &Kept, how: &HowTiles<'_>, area: Area) -> TilesUniform {
        let Grid { columns, rows, begins_below } = how.light_field.grid();
        let lenses = how.light_field.lenses();
        TilesUniform {
            background: how.background,
            views: kept.texture.depth_or_array_layers(),
            area: [area.left, area.top, area.width, area.height].map(|number| number as f32),
            tile: how.light_field.tile_size_beside(how.area.size()),
            grid: [columns, rows],
            panel: lenses.map_or([1; 2], |lenses| lenses.panel_px),
            begins_below: begins_below.into(),
            flips: lenses.map_or([0; 2], |lenses| [lenses.flips_x, lenses.flips_y].map(u32::from)),
            padding: [0; 3],
        }
    }

    fn group(&self, device: &wgpu::Device, kept: &Kept, uniform: &TilesUniform) -> wgpu::BindGroup {
        let buffer = |label, contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let uniform = buffer("tiles", bytemuck::bytes_of(uniform), wgpu::BufferUsages::UNIFORM);
        let nothing = buffer("nothing seen", &[0; size_of::<SeenUniform>()], wgpu::BufferUsages::STORAGE);
        let columns = self.columns.as_ref();
        let views = kept.texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let shown = self.panel.as_ref().map_or(&self.no_panel, |panel| &panel.shown);
        let starts = columns.map_or(&nothing, |columns| &columns.starts);
        let seen = columns.map_or(&nothing, |columns| &columns.seen);
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tiles"),
            layout: &self.passes.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&views) },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: wgpu::BindingResource::Sampler(&self.passes.sampler),
                },
                wgpu::BindGroupEntry { binding: 3, resource: starts.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 4, resource: seen.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 5, resource: wgpu::BindingResource::TextureView(shown) },
            ],
        })
    }
}

impl Columns {
    fn new(device: &wgpu::Device, light_field: &LightField, size: [u32; 2]) -> Result<Self, Failure> {
        let columns = light_field.views_seen(size).map_err(Failure::input)?;
        let ends = columns.iter().scan(0, |end, views| {
            *end += views.len() as u32;
            Some(*end)
        });
        let starts: Vec<u32> = std::iter::once(0).chain(ends).collect();
        let mut seen: Vec<SeenUniform> = columns.iter().flatten().map(SeenUniform::from).collect();
        if seen.is_empty() {
            seen.push(bytemuck::Zeroable::zeroed());
        }
        let buffer = |label, contents: &[u8]| {
            let usage = wgpu::BufferUsages::STORAGE;
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        Ok(Self {
            light_field: light_field.clone(),
            size,
            starts: buffer("columns", bytemuck::cast_slice(&starts)),
            seen: buffer("seen", bytemuck::cast_slice(&seen)),
        })
    }
}

impl Panel {
    fn new(gpu: &Gpu, lenses: &Lenticular, views: u32) -> Result<Self, Failure> {
        let largest = gpu.capabilities().largest_2d_side;
        let [width, height] = lenses.panel_px;
        if width.max(height) > largest {
            return Err(Failure::input(format!(
                "a panel of {width}x{height} pixels: the device takes {largest} along each side"
            )));
        }
        let texture = shown_texture(gpu.device(), lenses.panel_px);
        let texels: Vec<[u8; 4]> =
            lenses.views(views).into_iter().map(|[red, green, blue]| [red, green, blue, 0]).collect();
        gpu.queue().write_texture(
            texture.as_image_copy(),
            bytemuck::cast_slice(&texels),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None },
            texture.size(),
        );
        let shown = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { lenses: lenses.clone(), views, shown })
    }
}

impl Passes {
    fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let texture = |binding, sample_type, view_dimension| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false },
            count: None,
        };
        let buffer = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let sampler = wgpu::BindGroupLayoutEntry {
            binding: 2,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            count: None,
        };
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let read_only = wgpu::BufferBindingType::Storage { read_only: true };
        let exact = wgpu::TextureSampleType::Float { filterable: false };
        let filtered = wgpu::TextureSampleType::Float { filterable: true };
        let keep_layout = layout("keep", &[texture(0, exact, wgpu::TextureViewDimension::D2)]);
        let tiles_layout = layout(
            "tiles",
            &[
                buffer(0, wgpu::BufferBindingType::Uniform),
                texture(1, filtered, wgpu::TextureViewDimension::D2Array),
                sampler,
                buffer(3, read_only),
                buffer(4, read_only),
                texture(5, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2),
            ],
        );
        let everywhere = device.create_shader_module(wgpu::include_wgsl!("show.wgsl"));
        let pipeline = |layout: &wgpu::BindGroupLayout, module: &wgpu::ShaderModule, entry_point, format| {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry_point),
                bind_group_layouts: &[Some(layout)],
                immediate_size: 0,
            });
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &everywhere,
                    entry_point: Some("everywhere"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState::from(format))],
                }),
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                multiview_mask: None,
                cache: None,
            })
        };
        let keep = device.create_shader_module(wgpu::include_wgsl!("keep.wgsl"));
        let tiles = device.create_shader_module(wgpu::include_wgsl!("tiles.wgsl"));
        let pipelines = [
            (Arrangement::Quilt, "quilt"),
            (Arrangement::LightField, "light_field"),
            (Arrangement::Panel, "panel"),
        ]
        .into_iter()
        .map(|(arrangement, entry_point)| (arrangement, pipeline(&tiles_layout, &tiles, entry_point, format)))
        .collect();
        Self {
            keep: pipeline(&keep_layout, &keep, "keep", FORMAT),
            keep_layout,
            layout: tiles_layout,
            pipelines,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("interpolated"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }

    /// Encodes the keeping of a view in a layer.
    fn keep(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        cast: &wgpu::TextureView,
        layers: &wgpu::Texture,
        layer: u32,
    ) {
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("keep"),
            layout: &self.keep_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(cast),
            }],
        });
        let into = layers.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("keep"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &into,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.keep);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Room for views of a size.
fn layers(device: &wgpu::Device, [width, height]: [u32; 2], views: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("views"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: views },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Room for what a panel's sub-pixels show.
fn shown_texture(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("views of sub-pixels"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: SHOWN_FORMAT,
        usage: wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pipeline_builds_on_the_noop_device() {
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let passes = Passes::new(&device, wgpu::TextureFormat::Bgra8Unorm);
        let all = Arrangement::ALL.into_iter().filter(|arrangement| arrangement.is_of_display());
        assert_eq!(passes.pipelines.len(), all.count());
    }

    #[test]
    fn pictures_of_displays_keep_their_shape() {
        let light_field = LightField::default();
        let picture = |arrangement, area| {
            HowTiles { arrangement, area, background: [0.0; 3], light_field: &light_field }.picture()
        };
        let area = Area { left: 10, top: 20, width: 1000, height: 400 };
        let seen = picture(Arrangement::LightField, area);
        assert_eq!(seen, Area { left: 10 + 350, top: 20, width: 300, height: 400 });
        let quilt = picture(Arrangement::Quilt, area);
        assert_eq!((quilt.width % 8, quilt.height % 6), (0, 0));
        assert!(quilt.height <= 400 && quilt.height > 390);
        assert_eq!(picture(Arrangement::Panel, area).size(), [1, 1], "without a calibration");
    }

    #[test]
    fn light_ends_where_the_simulators_does() {
        let dark = format!("const DARK = {:e};", wheatstone_core::lightfield::simulator::DARK);
        assert!(include_str!("tiles.wgsl").contains(&dark), "{dark}");
    }
}
