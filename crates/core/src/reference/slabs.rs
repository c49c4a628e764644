//! Anchors: pictures whose rays leave what they pass in slabs of depth, ray by ray in double precision.

use super::accumulate::Pixels;
use super::aids::Aids;
use super::classify::{Classify, PreIntegrated, Value, ValueGradient};
use super::composite::each_visible;
use super::context::Context;
use super::gathered::Gathered;
use super::lanes::Lanes;
use super::lanes_exact::Exact;
use super::ray::Ray;
use super::recorded::cast_rows;
use super::renderer::{Cast, Caster};
use crate::cast::{CastParameters, Classifier};
use crate::lightfield::anchors::{AnchorError, DepthSlabs, SlabPicture, SlabWriter};
use crate::scene::Mode;
use crate::view::View;
use glam::Vec4;
use rayon::prelude::*;

impl Caster {
    /// Casts a composite in double precision and keeps, besides the picture of [`Caster::cast_exactly`], what its rays have in each
    /// slab of depth: what [`anchors::derive`](crate::lightfield::anchors::derive) makes other views of.
    ///
    /// # Errors
    /// Other modes.
    pub fn cast_slabs(
        &self,
        parameters: &CastParameters,
        aids: &Aids<'_>,
        view: &View,
        slabs: &DepthSlabs,
    ) -> Result<(Cast, SlabPicture), AnchorError> {
        if parameters.mode != Mode::Composite {
            return Err(AnchorError::Mode(parameters.mode));
        }
        let context = self.context(parameters, aids);
        Ok(match parameters.classifier {
            Classifier::ValueGradient => cast_view::<ValueGradient>(&context, view, slabs),
            Classifier::PreIntegrated => cast_view::<PreIntegrated>(&context, view, slabs),
            Classifier::Value | Classifier::Isovalue => cast_view::<Value>(&context, view, slabs),
        })
    }
}

fn cast_view<C: Classify>(context: &Context<'_>, view: &View, slabs: &DepthSlabs) -> (Cast, SlabPicture) {
    let mut picture = SlabPicture::clear(view.size, slabs.count);
    let [width, height] = view.size.map(|side| side as usize);
    // The cells of a row of pixels, slab by slab.
    let mut rows: Vec<Vec<&mut [u32]>> = (0..height).map(|_| Vec::new()).collect();
    for (line, row) in picture.cells.chunks_mut(width).zip((0..height).cycle()) {
        rows[row].push(line);
    }
    let rows = rows.into_par_iter().zip(picture.ends.par_chunks_mut(width));
    let cast = cast_rows(context, view, rows, |(lines, ends), column, _, ray| {
        let cells = lines.iter_mut().map(|line| &mut line[column]).collect();
        let writer = SlabWriter::new(cells, &mut ends[column]);
        let recorder = Recorder { slabs, writer, gathered: Gathered::nothing(()), slab: None };
        cast_ray::<C>(context, ray, recorder)
    });
    (cast, picture)
}

fn cast_ray<C: Classify>(
    context: &Context<'_>,
    ray: &Ray<Exact>,
    mut recorder: Recorder<'_>,
) -> Pixels<Exact> {
    let least_transmittance = Exact::splat((), 1.0 - context.parameters.termination_alpha);
    let mut gathered = Gathered::nothing(());
    let taken = each_visible::<C, Exact>(context, (), ray, |sample| {
        gathered.add((), sample.rgb, sample.transmittance);
        gathered.note_hit((), gathered.transmittance, ray.depth_m(sample.index));
        if sample.transmittance < Exact::from(1.0) {
            recorder.enter(recorder.slabs.at(f64::from(ray.depth_m(sample.index))));
            recorder.gathered.add((), sample.rgb, sample.transmittance);
        }
        gathered.transmittance <= least_transmittance
    });
    let color = recorder.end_slab();
    if let Some(slab) = recorder.slab
        && gathered.transmittance <= least_transmittance
    {
        recorder.writer.hide_behind(slab, (color.truncate() / color.w).to_array());
    }
    gathered.pixels((), taken)
}

/// Cuts a ray into slabs.
struct Recorder<'a> {
    slabs: &'a DepthSlabs,
    writer: SlabWriter<'a>,
    /// What the ray has in the slab.
    gathered: Gathered<Exact>,
    /// The slab of the last visible sample.
    slab: Option<u32>,
}

impl Recorder<'_> {
    /// Ends the slab that the ray was in if the next sample is in another.
    fn enter(&mut self, slab: u32) {
        if self.slab != Some(slab) {
            self.end_slab();
            self.slab = Some(slab);
        }
    }

    /// Writes the slab that the ray is in, and returns what is in it, premultiplied RGBA.
    fn end_slab(&mut self) -> Vec4 {
        let gathered = std::mem::replace(&mut self.gathered, Gathered::nothing(()));
        let [r, g, b, through] = [gathered.rgb.x, gathered.rgb.y, gathered.rgb.z, gathered.transmittance]
            .map(|x| f64::from(x) as f32);
        let color = Vec4::new(r, g, b, 1.0 - through);
        if let Some(slab) = self.slab {
            self.writer.put(slab, color);
        }
        color
    }
}
