//! The picture that is being cast.

use super::cells::RigCells;
use super::clock::PieceClock;
use super::front::Front;
use super::piece::Piece;
use super::spares::Spares;
use super::wanted::Wanted;
use crate::gpu::{Gpu, GpuError};
use crate::groups::Bindings;
use crate::pacer::{BAND_ROWS, spreading_stride};
use crate::piece::Picture;
use crate::renderer::{Prepared, Renderer};
use crate::squares::Squares;
use crate::target::Target;
use crate::tile_pass::TileList;
use crate::uniforms::ViewUniform;
use std::sync::Arc;
use wheatstone_core::view::View;

/// Pictures of a rig's views, cell by cell.
#[derive(Debug)]
pub(super) struct UnderWay {
    wanted: Wanted,
    cells: RigCells,
    /// The settings with the steps of the quality.
    pub(super) prepared: Arc<Prepared>,
    views: Vec<ViewUnderWay>,
    is_begun: bool,
}

#[derive(Debug)]
struct ViewUnderWay {
    rays: ViewUniform,
    /// What may be seen.
    covered: Squares,
    /// What the picture before has left.
    stale: Squares,
    target: Target,
    list: Option<TileList>,
    group: wgpu::BindGroup,
}

impl UnderWay {
    /// Makes room for a picture.
    ///
    /// # Errors
    /// An impossible size, no memory, a lost device.
    pub(super) fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        spares: &mut Spares,
        wanted: Wanted,
        cells: RigCells,
        prepared: Arc<Prepared>,
    ) -> Result<Self, GpuError> {
        let [width, _] = wanted.size();
        let cell_rows = cells.grid().rect(0).rows.end.next_multiple_of(BAND_ROWS);
        let states =
            spares.states(gpu, u64::from(width) * u64::from(cell_rows) * prepared.variant.state_bytes());
        let begin = |view: View| {
            let mut target = spares.target(gpu, &prepared, view.size)?;
            let list =
                prepared.listing.map(|_| renderer.tile_pass.list(&gpu.device, view.size, spares.list()));
            let tiles = list.as_ref().map_or(&renderer.unused[1], |list| &list.tiles);
            let group = renderer.target_group(gpu, &target, [&states, tiles]);
            let covered = Squares::covered(&view, &prepared.occupied_corners_world());
            let stale = target.drawn.clone();
            target.drawn = stale.around(&covered);
            let rays = ViewUniform::new(&prepared.parameters, &view);
            Ok(ViewUnderWay { rays, covered, stale, target, list, group })
        };
        let views = wanted.cast_views().map(begin).collect::<Result<_, GpuError>>()?;
        Ok(Self { wanted, cells, prepared, views, is_begun: false })
    }

    /// All that is to do for a cell, the first of the given place in its batch; nothing if that is nothing.
    pub(super) fn whole_cell(&self, place: usize, cell: usize) -> Option<Piece> {
        let (view, of_cell) = self.cells.squares(cell);
        let ViewUnderWay { covered, stale, .. } = &self.views[view];
        let (squares, stale) = (of_cell.within(covered), of_cell.within(stale));
        let is_idle = squares.is_empty() && stale.is_empty();
        (!is_idle).then_some(Piece { place, view, stale, squares, first_sample: 0, sample_limit: u32::MAX })
    }

    /// Encodes pieces, those that cast something timed one after the other; `uniforms` has room for all.
    ///
    /// # Errors
    /// A kernel that the driver refuses, a lost device.
    pub(super) fn encode(
        &mut self,
        gpu: &Gpu,
        renderer: &mut Renderer,
        encoder: &mut wgpu::CommandEncoder,
        (pieces, uniforms): (&[Piece], &wgpu::Buffer),
        clock: &PieceClock,
    ) -> Result<(), GpuError> {
        if !std::mem::replace(&mut self.is_begun, true) {
            self.views
                .iter()
                .filter_map(|view| view.list.as_ref())
                .for_each(|list| list.begin_picture(encoder));
        }
        let bytes = size_of::<ViewUniform>() as u64;
        let rays: Vec<ViewUniform> = pieces.iter().map(|piece| self.rays(gpu, piece)).collect();
        gpu.queue.write_buffer(uniforms, 0, bytemuck::cast_slice(&rays));
        let mut timed = 0;
        for ((piece, rays), offset) in pieces.iter().zip(&rays).zip((0..).step_by(bytes as usize)) {
            let view = &self.views[piece.view];
            view.target.blank_squares(encoder, &renderer.zeros, &piece.stale);
            if piece.squares.is_empty() {
                continue;
            }
            let pipeline = renderer.piece_pipeline(gpu, &self.prepared, rays)?;
            encoder.copy_buffer_to_buffer(uniforms, offset, &self.prepared.view_uniform, 0, bytes);
            let Prepared { frame, volume, .. } = &*self.prepared;
            let picture = Picture {
                bindings: Bindings { frame, volume, target: &view.group },
                list: (view.list.as_ref().zip(self.prepared.listing))
                    .map(|(list, listing)| (&renderer.tile_pass, list, listing)),
            };
            let counts = piece.squares.counts();
            picture.encode_piece(encoder, &pipeline, piece.first_sample, counts, clock.stamps(timed));
            timed += 1;
        }
        Ok(())
    }

    fn rays(&self, gpu: &Gpu, piece: &Piece) -> ViewUniform {
        let rays = &self.views[piece.view].rays;
        let bands = piece.squares.bands.len() as u32;
        ViewUniform {
            first_row: piece.squares.bands.start * BAND_ROWS,
            row_count: piece.squares.rows(rays.height),
            first_column: piece.squares.columns.start * BAND_ROWS,
            first_sample: piece.first_sample,
            sample_limit: piece.sample_limit,
            band_stride: if gpu.description().is_software { spreading_stride(bands) } else { 1 },
            ..*rays
        }
    }

    /// The picture is whole.
    pub(super) fn complete(self, spares: &mut Spares) -> Front {
        let complete = |view: ViewUnderWay| {
            view.list.into_iter().for_each(|list| spares.give_back_list(list));
            let mut target = view.target;
            target.drawn = view.covered;
            target
        };
        let targets = self.views.into_iter().map(complete).collect();
        Front { wanted: self.wanted, prepared: self.prepared, targets }
    }

    /// The picture is given up.
    pub(super) fn give_up(self, spares: &mut Spares) {
        for view in self.views {
            view.list.into_iter().for_each(|list| spares.give_back_list(list));
            spares.give_back_target(view.target);
        }
    }
}
