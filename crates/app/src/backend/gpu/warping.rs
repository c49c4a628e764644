//! A picture that is warped on the GPU.

use super::GpuEngine;
use crate::backend::Shot;
use crate::failure::Failure;
use crate::layering::Layering;
use std::time::{Duration, Instant};
use wheatstone_core::image::Image;
use wheatstone_core::view::View;
use wheatstone_core::warp::{GridSettings, VolumetricSettings, WarpError};
use wheatstone_render::warp::{DepthPass, LayerDepths, Picture, Shown, VolumetricWarps, Warps};
use wheatstone_render::{LayersError, Prepared, Target};

/// The picture, and what it is warped with and to.
pub(crate) struct GpuWarping {
    warps: Warps,
    layered: Option<Layered>,
    shot: Shot,
    target: Target,
    view: View,
    warped: Picture,
}

/// What volumetric warps need besides.
struct Layered {
    prepared: Prepared,
    settings: VolumetricSettings,
    depth_pass: DepthPass,
    depths: LayerDepths,
    warps: VolumetricWarps,
}

impl GpuEngine {
    /// Room for pictures of a shot like a view, with their layers if volumetric warps are to be made.
    pub(crate) fn warping(
        &mut self,
        shot: Shot,
        view: View,
        layering: Option<&Layering>,
    ) -> Result<GpuWarping, Failure> {
        let Self { gpu, renderer, scenes, .. } = self;
        let layered = layering.map(|Layering { thresholds, settings }| {
            let prepared = renderer.with_layers(gpu, &scenes[shot.0].prepared, thresholds);
            Ok::<_, Failure>(Layered {
                prepared: prepared.map_err(|error| match error {
                    LayersError::Gpu(error) => Failure::Gpu(error),
                    other => Failure::input(other),
                })?,
                settings: *settings,
                depth_pass: DepthPass::new(gpu)?,
                depths: LayerDepths::new(gpu, view.size)?,
                warps: VolumetricWarps::new(gpu, Picture::FORMAT)?,
            })
        });
        let layered = layered.transpose()?;
        let target = match layered {
            Some(_) => Target::with_layers(gpu, view.size)?,
            None => Target::new(gpu, view.size)?,
        };
        let warps = Warps::new(gpu, Picture::FORMAT)?;
        Ok(GpuWarping { warps, layered, shot, target, view, warped: Picture::new(gpu, view.size)? })
    }

    /// Casts the picture of a view; also the time that finding the depths of its layers takes.
    pub(crate) fn cast_warped(
        &mut self,
        warping: &mut GpuWarping,
        view: View,
    ) -> Result<[Duration; 2], Failure> {
        let Self { gpu, renderer, scenes, .. } = self;
        let GpuWarping { layered, shot, target, .. } = warping;
        let prepared = layered.as_ref().map_or(&*scenes[shot.0].prepared, |layered| &layered.prepared);
        let start = Instant::now();
        renderer.render(gpu, prepared, &[view], std::slice::from_mut(target))?;
        let cast = start.elapsed();
        warping.view = view;
        let GpuWarping { layered, target, .. } = &*warping;
        let Some(Layered { depth_pass, depths, .. }) = layered else { return Ok([cast, Duration::ZERO]) };
        let finding = self.timed(|encoder| depth_pass.encode(&self.gpu, encoder, target, depths))?;
        Ok([cast, finding])
    }

    /// The picture as it is.
    pub(crate) fn read_source(&self, warping: &GpuWarping) -> Result<Image, Failure> {
        Ok(warping.target.read(&self.gpu)?.image)
    }

    /// The picture on a plane.
    pub(crate) fn quad(&self, warping: &mut GpuWarping, wanted: &View) -> Result<Duration, Failure> {
        let GpuWarping { warps, shot, target, view, warped, .. } = warping;
        let shown = self.shown(*shot, target, *view);
        self.timed(|encoder| warps.quad(&self.gpu, encoder, &shown, wanted, warped.canvas()))
    }

    /// The picture as a surface of its first hits.
    pub(crate) fn grid(&self, warping: &mut GpuWarping, wanted: &View) -> Result<Duration, Failure> {
        let GpuWarping { warps, shot, target, view, warped, .. } = warping;
        let shown = self.shown(*shot, target, *view);
        let settings = GridSettings::default();
        self.timed(|encoder| warps.grid(&self.gpu, encoder, &shown, wanted, settings, warped.canvas()))
    }

    /// The picture cast anew through its layers.
    pub(crate) fn volumetric(&self, warping: &mut GpuWarping, wanted: &View) -> Result<Duration, Failure> {
        let GpuWarping { layered, shot, target, view, warped, .. } = warping;
        let Some(Layered { warps, depths, settings, .. }) = layered else {
            return Err(Failure::input(WarpError::NoLayers));
        };
        let shown = self.shown(*shot, target, *view);
        self.timed(|encoder| {
            warps.encode(&self.gpu, encoder, &shown, depths, wanted, settings, warped.canvas())
        })
    }

    /// What the last warp has made.
    pub(crate) fn read_warped(&self, warping: &GpuWarping) -> Result<Image, Failure> {
        Ok(warping.warped.read(&self.gpu)?)
    }

    fn shown<'a>(&self, shot: Shot, target: &'a Target, view: View) -> Shown<'a> {
        Shown::new(target, view, &self.scenes[shot.0].prepared)
    }

    /// Encodes, submits and waits.
    fn timed(
        &self,
        encode: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<(), WarpError>,
    ) -> Result<Duration, Failure> {
        let start = Instant::now();
        let mut encoder =
            self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encode(&mut encoder).map_err(Failure::input)?;
        self.gpu.queue().submit([encoder.finish()]);
        self.gpu.wait()?;
        Ok(start.elapsed())
    }
}
