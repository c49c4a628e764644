//! How far away what the eyes are shown is, for runtimes that move pictures about by it.

use crate::failure::Failure;
use crate::viewer::eyes::room;
use wheatstone_core::view::View;
use wheatstone_core::warp::{GridSettings, WarpError};
use wheatstone_render::Gpu;
use wheatstone_render::live::Front;
use wheatstone_render::warp::{Canvas, GridDepths, Shown};

/// How many times fewer columns and rows depths have than pictures.
const COARSER: u32 = 2;

/// Depths of first hits.
pub(crate) struct Depths {
    warps: GridDepths,
    canvases: [Option<Canvas>; 2],
}

impl Depths {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        Ok(Self { warps: GridDepths::new(gpu)?, canvases: [None, None] })
    }

    /// Near over depth of the first hits of the newest whole picture, as the left and the right eye see them. Submits what draws them.
    pub(crate) fn show(
        &mut self,
        gpu: &Gpu,
        front: &Front,
        wanted: &[View; 2],
    ) -> Result<Option<[wgpu::TextureView; 2]>, Failure> {
        let sources: Vec<_> = front.pictures().collect();
        let Some(last) = sources.len().checked_sub(1) else { return Ok(None) };
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (eye, (canvas, view)) in self.canvases.iter_mut().zip(wanted).enumerate() {
            let (target, cast_from) = sources[eye.min(last)];
            let shown = Shown::new(target, cast_from, front.prepared());
            let view = View { size: view.size.map(|side| side.div_ceil(COARSER)), ..*view };
            let kept = canvas.take().filter(|kept| kept.size() == view.size);
            let into = canvas.insert(match kept {
                Some(kept) => kept,
                None => room(gpu, view.size, GridDepths::FORMAT)?,
            });
            self.warps
                .encode(gpu, &mut encoder, &shown, &view, GridSettings::default(), into)
                .map_err(|error: WarpError| Failure::Internal(error.into()))?;
        }
        gpu.queue().submit([encoder.finish()]);
        gpu.check()?;
        let [left, right] = self.canvases.each_ref().map(|canvas| canvas.as_ref().map(Canvas::view).cloned());
        Ok(left.zip(right).map(<[_; 2]>::from))
    }
}
