//! Draws a refresh: pictures, then panels over them.

use super::canvas::{read_texture, texture};
use super::capture::{Capture, Subject};
use super::show::{Area, Show};
use super::state::{Arrangement, LightField};
use super::tiles::{HowTiles, Tiles};
use super::ui::PANEL;
use crate::failure::Failure;
use crate::picture::{Bits, write_png};
use egui::epaint::ClippedPrimitive;
use egui::{FullOutput, TexturesDelta};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use wheatstone_render::Gpu;
use wheatstone_render::live::Front;

/// What is kept between refreshes.
pub(crate) struct Screen {
    /// Of what is drawn on.
    format: wgpu::TextureFormat,
    show: Show,
    /// Made when first asked for.
    tiles: Option<Tiles>,
    /// The display whose views are shown, if some are.
    light_field: Option<LightField>,
    panels: Renderer,
}

/// The pictures of a refresh.
pub(crate) struct Pictures {
    pub(crate) arrangement: Arrangement,
    /// In the window, pixels.
    pub(crate) area: Area,
    pub(crate) background: [f32; 3],
    /// Of the left and the right eye; none as long as there are none, and of the views of a light-field display.
    pub(crate) eyes: Option<[wgpu::TextureView; 2]>,
}

/// The panels of a refresh, as triangles.
pub(crate) struct Panels {
    primitives: Vec<ClippedPrimitive>,
    descriptor: ScreenDescriptor,
    textures: TexturesDelta,
}

impl Pictures {
    /// How the views of a display are drawn in their place.
    fn of_display<'a>(&self, light_field: &'a LightField) -> HowTiles<'a> {
        let Self { arrangement, area, background, .. } = *self;
        HowTiles { arrangement, area, background, light_field }
    }
}

impl Panels {
    /// Those of a pass, on a window of some pixels.
    pub(crate) fn new(context: &egui::Context, output: &mut FullOutput, size: [u32; 2]) -> Self {
        let pixels_per_point = output.pixels_per_point;
        let shapes = std::mem::take(&mut output.shapes);
        Self {
            primitives: context.tessellate(shapes, pixels_per_point),
            descriptor: ScreenDescriptor { size_in_pixels: size, pixels_per_point },
            textures: std::mem::take(&mut output.textures_delta),
        }
    }
}

impl Screen {
    pub(crate) fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        Self {
            format,
            show: Show::new(gpu.device(), format),
            tiles: None,
            light_field: None,
            panels: Renderer::new(
                gpu.device(),
                format,
                RendererOptions { dithering: false, ..RendererOptions::default() },
            ),
        }
    }

    /// Takes in what has become of textures; once for each pass, whether it is drawn or not.
    pub(crate) fn update(&mut self, gpu: &Gpu, panels: &mut Panels) {
        for (id, deltas) in panels.textures.set.drain() {
            for delta in &deltas {
                self.panels.update_texture(gpu.device(), gpu.queue(), id, delta);
            }
        }
    }

    /// From now on shows the views of a display's newest whole picture, the `picture`th that has been cast; whether there are some.
    pub(crate) fn show_display(
        &mut self,
        gpu: &Gpu,
        (front, picture): (&Front, u64),
        pictures: &Pictures,
        light_field: &LightField,
    ) -> Result<bool, Failure> {
        let tiles = match self.tiles.take() {
            Some(tiles) => self.tiles.insert(tiles),
            None => self.tiles.insert(Tiles::new(gpu, self.format)?),
        };
        self.light_field = None;
        if !tiles.keep(gpu, front, picture, light_field)? {
            return Ok(false);
        }
        tiles.prepare(gpu, &pictures.of_display(light_field))?;
        self.light_field = Some(light_field.clone());
        Ok(true)
    }

    /// From now on shows eyes' pictures alone.
    pub(crate) fn show_eyes(&mut self) {
        self.light_field = None;
    }

    /// Draws pictures and panels.
    pub(crate) fn draw(
        &mut self,
        gpu: &Gpu,
        sheet: &wgpu::TextureView,
        pictures: &Pictures,
        panels: &Panels,
    ) -> wgpu::SubmissionIndex {
        let (device, queue) = (gpu.device(), gpu.queue());
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut commands =
            self.panels.update_buffers(device, queue, &mut encoder, &panels.primitives, &panels.descriptor);
        let mut pass = begin(&mut encoder, sheet).forget_lifetime();
        self.draw_pictures(gpu, &mut pass, pictures);
        let [width, height] = panels.descriptor.size_in_pixels;
        pass.set_scissor_rect(0, 0, width, height);
        self.panels.render(&mut pass, &panels.primitives, &panels.descriptor);
        drop(pass);
        commands.push(encoder.finish());
        queue.submit(commands)
    }

    /// Writes what a capture is of, once more as it has been drawn: PNG; waits for the device.
    pub(crate) fn write(
        &mut self,
        gpu: &Gpu,
        capture: &Capture,
        pictures: &Pictures,
        panels: &Panels,
    ) -> Result<(), Failure> {
        let size = match capture.subject {
            Subject::Picture => pictures.area.size(),
            Subject::Window => panels.descriptor.size_in_pixels,
        };
        let texture = texture(gpu, size, self.format)?;
        let sheet = texture.create_view(&wgpu::TextureViewDescriptor::default());
        match capture.subject {
            Subject::Picture => {
                let alone = Pictures { area: Area::whole(size), eyes: pictures.eyes.clone(), ..*pictures };
                self.draw_pictures_alone(gpu, &sheet, &alone);
            }
            Subject::Window => {
                self.draw(gpu, &sheet, pictures, panels);
            }
        }
        write_png(&capture.path, &read_texture(gpu, &texture)?, Bits::Eight)
    }

    /// Draws pictures alone.
    fn draw_pictures_alone(&self, gpu: &Gpu, sheet: &wgpu::TextureView, pictures: &Pictures) {
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = begin(&mut encoder, sheet);
        self.draw_pictures(gpu, &mut pass, pictures);
        drop(pass);
        gpu.queue().submit([encoder.finish()]);
    }

    /// Lets go of textures that are not drawn any more.
    pub(crate) fn free(&mut self, panels: &Panels) {
        panels.textures.free.iter().for_each(|id| self.panels.free_texture(id));
    }

    fn draw_pictures(&self, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>, pictures: &Pictures) {
        let Pictures { arrangement, area, background, eyes } = pictures;
        if let Some([left, right]) = eyes {
            let how = (*arrangement, *area, *background);
            self.show.draw(gpu.device(), gpu.queue(), pass, how, [left, right]);
        } else if let (Some(tiles), Some(light_field)) = (&self.tiles, &self.light_field) {
            tiles.draw(gpu, pass, &pictures.of_display(light_field));
        }
    }
}

fn begin<'e>(encoder: &'e mut wgpu::CommandEncoder, sheet: &wgpu::TextureView) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("refresh"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: sheet,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r: PANEL[0], g: PANEL[1], b: PANEL[2], a: 1.0 }),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    })
}
