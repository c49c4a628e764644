//! The second eye as a novel view of what the rays of the first pass through: layers of emission and absorption (VR §5.3.3).

use super::PairError;
use super::pair::{PairFrame, PairReport};
use crate::gpu::{Gpu, GpuError};
use crate::renderer::{Prepared, Renderer};
use crate::squares::Squares;
use crate::target::{Target, blank_layers, layer_bytes, layer_texture};
use crate::warp::{Canvas, DepthPass, LayerDepths, Shown, VolumetricWarps};
use std::time::Instant;
use wheatstone_core::warp::{LayerThresholds, VolumetricSettings};

/// Pipelines, and room for the layers of a picture: that of the last pair.
#[derive(Debug)]
pub(crate) struct NovelViewPass {
    depth_pass: DepthPass,
    warps: VolumetricWarps,
    room: Option<Room>,
}

/// Room for layers and what is found out about them.
#[derive(Debug)]
struct Room {
    size: [u32; 2],
    /// Lent to the reference picture for a cast.
    layers: Option<wgpu::Texture>,
    /// What of the layers is not blank at most.
    drawn: Squares,
    depths: LayerDepths,
}

impl Room {
    fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let layers = Some(layer_texture(gpu, size)?);
        Ok(Self { size, layers, drawn: Squares::default(), depths: LayerDepths::new(gpu, size)? })
    }

    fn blank(&mut self, gpu: &Gpu, zeros: &wgpu::Buffer) {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if let Some(layers) = &self.layers {
            blank_layers(&mut encoder, zeros, layers, &self.drawn);
        }
        gpu.queue.submit([encoder.finish()]);
        self.drawn = Squares::default();
    }
}

impl NovelViewPass {
    fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let warps = VolumetricWarps::new(gpu, Target::COLOR_FORMAT)?;
        Ok(Self { depth_pass: DepthPass::new(gpu)?, warps, room: None })
    }
}

impl Renderer {
    /// Casts the reference view of a pair with layers and shows them as the derived view wants them, into pictures that are blank.
    pub(super) fn render_novel_view(
        &mut self,
        frame: &PairFrame<'_>,
        [reference, derived]: &mut [&mut Target; 2],
    ) -> Result<PairReport, PairError> {
        let gpu = frame.gpu;
        let prepared = self.with_layers(gpu, frame.prepared, &LayerThresholds::default())?;
        let mut pass = match self.novel_view_pass.take() {
            Some(pass) => pass,
            None => NovelViewPass::new(gpu)?,
        };
        let kept = pass.room.take().filter(|room| room.size == frame.size());
        let mut room = match kept {
            Some(room) => room,
            None => Room::new(gpu, frame.size())?,
        };
        room.blank(gpu, &self.zeros);
        std::mem::swap(&mut reference.layers, &mut room.layers);
        reference.drawn = Squares::default();
        let made = self.cast_and_warp(frame, &prepared, &pass, &room.depths, [reference, derived]);
        room.drawn = reference.drawn.clone();
        std::mem::swap(&mut reference.layers, &mut room.layers);
        pass.room = Some(room);
        self.novel_view_pass = Some(pass);
        made
    }

    fn cast_and_warp(
        &mut self,
        frame: &PairFrame<'_>,
        prepared: &Prepared,
        pass: &NovelViewPass,
        depths: &LayerDepths,
        [reference, derived]: [&mut Target; 2],
    ) -> Result<PairReport, PairError> {
        let (gpu, wanted) = (frame.gpu, frame.epipolar.derived());
        let start = Instant::now();
        self.cast(gpu, prepared, frame.epipolar.reference(), reference)?;
        let cast = start.elapsed();
        let shown = Shown::new(reference, *frame.epipolar.reference(), prepared);
        let mut into = Canvas::new(derived.color.create_view(&wgpu::TextureViewDescriptor::default()));
        let settings = VolumetricSettings::default();
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        pass.depth_pass.encode(gpu, &mut encoder, reference, depths)?;
        pass.warps.encode(gpu, &mut encoder, &shown, depths, wanted, &settings, &mut into)?;
        derived.drawn = Squares::of(&shown.covered_by_volume(wanted)?);
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        let composite = start.elapsed() - cast;
        Ok(PairReport { bytes: layer_bytes(frame.size()), cast, composite, ..PairReport::default() })
    }
}
