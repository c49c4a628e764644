//! The newest whole picture's layers of emission and absorption, as they look from where the eyes are.

use crate::failure::Failure;
use wheatstone_core::view::View;
use wheatstone_core::warp::{VolumetricSettings, WarpError};
use wheatstone_render::Gpu;
use wheatstone_render::live::Front;
use wheatstone_render::warp::{Canvas, DepthPass, LayerDepths, Shown, VolumetricWarps};

/// Volumetric warps, and what they need of the picture.
pub(crate) struct NovelViews {
    depth_pass: DepthPass,
    warps: VolumetricWarps,
    /// Of each view of the picture.
    depths: Vec<LayerDepths>,
    /// The number of that picture.
    picture: Option<u64>,
}

impl NovelViews {
    /// To pictures of a format.
    pub(crate) fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Self, Failure> {
        let (depth_pass, warps) = (DepthPass::new(gpu)?, VolumetricWarps::new(gpu, format)?);
        Ok(Self { depth_pass, warps, depths: Vec::new(), picture: None })
    }

    /// Encodes finding where the layers of a picture are, unless they are known.
    pub(crate) fn follow(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        front: &Front,
        picture: u64,
    ) -> Result<(), Failure> {
        if self.picture == Some(picture) {
            return Ok(());
        }
        self.picture = None;
        let views: Vec<_> = front.pictures().map(|(target, _)| target).collect();
        if !self.depths.iter().map(LayerDepths::size).eq(views.iter().map(|target| target.size())) {
            let room = views.iter().map(|target| LayerDepths::new(gpu, target.size()));
            self.depths = room.collect::<Result<_, _>>()?;
        }
        for (target, depths) in views.into_iter().zip(&self.depths) {
            self.depth_pass.encode(gpu, encoder, target, depths).map_err(internal)?;
        }
        self.picture = Some(picture);
        Ok(())
    }

    /// Encodes what an eye sees of a view of the picture, the first of which is 0.
    pub(crate) fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        (index, shown): (usize, &Shown<'_>),
        wanted: &View,
        settings: &VolumetricSettings,
        into: &mut Canvas,
    ) -> Result<(), WarpError> {
        let depths = self.depths.get(index).ok_or(WarpError::NoLayers)?;
        self.warps.encode(gpu, encoder, shown, depths, wanted, settings, into)
    }
}

fn internal(error: WarpError) -> Failure {
    Failure::Internal(error.into())
}
