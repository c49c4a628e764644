//! The views of a light-field display: kept side by side on the device, and drawn into an area of the window.

mod passes;

use super::show::Area;
use super::state::{Arrangement, Grid, LightField};
use crate::failure::Failure;
use passes::{Passes, SeenUniform, TilesUniform, layers, shown_texture};
use wgpu::util::DeviceExt as _;
use wheatstone_core::lightfield::Lenticular;
use wheatstone_render::Gpu;
use wheatstone_render::live::Front;

/// Pipelines, and what is kept between refreshes.
pub(crate) struct Tiles {
    passes: Passes,
    kept: Option<Kept>,
    columns: Option<Columns>,
    panel: Option<Panel>,
    /// Stands in for a panel where none is shown.
    no_panel: wgpu::TextureView,
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
        let uniform = buffer(device, "tiles", bytemuck::bytes_of(uniform), wgpu::BufferUsages::UNIFORM);
        let nothing = [0; size_of::<SeenUniform>()];
        let nothing = buffer(device, "nothing seen", &nothing, wgpu::BufferUsages::STORAGE);
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
        Ok(Self {
            light_field: light_field.clone(),
            size,
            starts: buffer(device, "columns", bytemuck::cast_slice(&starts), wgpu::BufferUsages::STORAGE),
            seen: buffer(device, "seen", bytemuck::cast_slice(&seen), wgpu::BufferUsages::STORAGE),
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

/// A buffer of some bytes.
fn buffer(device: &wgpu::Device, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
