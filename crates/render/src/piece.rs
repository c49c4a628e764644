//! Pieces of a picture: what one dispatch of the cast takes.

use crate::cast_pass::{self, Workgroups};
use crate::gpu::{Gpu, GpuError};
use crate::groups::Bindings;
use crate::renderer::{Prepared, Renderer};
use crate::stamps::Stamps;
use crate::tile_pass::{Listing, TileList, TilePass};
use crate::uniforms::ViewUniform;

/// What the pieces of a picture have in common.
pub(crate) struct Picture<'a> {
    pub(crate) bindings: Bindings<'a>,
    /// What lists the tiles to cast, and by what; without it all are.
    pub(crate) list: Option<(&'a TilePass, &'a TileList, Listing)>,
}

impl Picture<'_> {
    /// Encodes samples of a piece of squares of `BAND_ROWS` pixels along x and y, which is in the view's uniform buffer. The
    /// dispatch of the first samples finds out which tiles have any.
    pub(crate) fn encode_piece(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        first_sample: u32,
        squares: [u32; 2],
        stamps: Stamps<'_>,
    ) {
        let Some((tile_pass, list, listing)) = self.list else {
            let workgroups = Workgroups::Counted(squares);
            return cast_pass::dispatch(encoder, pipeline, &self.bindings, workgroups, stamps);
        };
        let workgroups = Workgroups::Listed(&list.groups);
        if first_sample == 0 {
            tile_pass.dispatch(encoder, (list, listing), &self.bindings, squares, stamps.of_first());
            cast_pass::dispatch(encoder, pipeline, &self.bindings, workgroups, stamps.of_last());
        } else {
            cast_pass::dispatch(encoder, pipeline, &self.bindings, workgroups, stamps);
        }
    }
}

impl Renderer {
    /// The pipeline that casts a piece: another one where its rays are cast in parts.
    pub(crate) fn piece_pipeline(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        piece: &ViewUniform,
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        let is_whole = piece.sample_limit == u32::MAX;
        let variant = if is_whole { prepared.variant } else { prepared.variant.in_parts() };
        self.casts.pipeline(gpu, variant)
    }
}
