//! Anchors: pictures whose rays leave what they pass in slabs of depth, ray by ray in double precision.

use super::accumulate::Pixels;
use super::aids::Aids;
use super::classify::{Classify, PreIntegrated, Value, ValueGradient};
use super::composite::each_visible;
use super::context::Context;
use super::gathered::Gathered;
use super::lanes::Lanes;
use super::lanes_exact::Exact;
use super::ray::{PixelRay, Ray, pixels_of_box};
use super::renderer::{Cast, Caster, Reads};
use crate::cast::{CastParameters, Classifier};
use crate::image::Image;
use crate::lightfield::anchors::{AnchorError, DepthSlabs, SlabPicture, SlabWriter};
use crate::scene::Mode;
use crate::view::{RayField, View};
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
            Classifier::ValueGradient => cast_rows::<ValueGradient>(&context, view, slabs),
            Classifier::PreIntegrated => cast_rows::<PreIntegrated>(&context, view, slabs),
            Classifier::Value | Classifier::Isovalue => cast_rows::<Value>(&context, view, slabs),
        })
    }
}

fn cast_rows<C: Classify>(context: &Context<'_>, view: &View, slabs: &DepthSlabs) -> (Cast, SlabPicture) {
    let rays = RayField::new(view, context.parameters.texture_from_world);
    let dims = context.sampler.dims().as_dvec3();
    let [columns, rows] = pixels_of_box(view, context.parameters);
    let [width, height] = view.size;
    let mut image = Image::transparent(width, height);
    let mut reads = vec![Reads::default(); image.color.len()];
    let mut picture = SlabPicture::clear(view.size, slabs.count);
    let width = width as usize;
    // The cells of a row of pixels, slab by slab.
    let mut cells: Vec<Vec<&mut [u32]>> = (0..height).map(|_| Vec::new()).collect();
    for (line, row) in picture.cells.chunks_mut(width).zip((0..height as usize).cycle()) {
        cells[row].push(line);
    }
    let pictured = image
        .color
        .par_chunks_mut(width)
        .zip(image.depth_m.par_chunks_mut(width))
        .zip(reads.par_chunks_mut(width))
        .zip(cells);
    pictured.enumerate().filter(|(row, _)| rows.contains(row)).for_each(
        |(row, (((color, depth_m), reads), mut cells))| {
            for column in columns.clone() {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let ray = PixelRay::new(&rays, context.parameters, x, y);
                if ray.sample_count == 0 {
                    continue;
                }
                let cells = cells.iter_mut().map(|line| &mut line[column]).collect();
                let recorder = Recorder {
                    slabs,
                    writer: SlabWriter::new(cells),
                    gathered: Gathered::nothing(()),
                    slab: None,
                };
                let pixel = cast_ray::<C>(context, &Ray::new((), dims, &[ray]), recorder);
                color[column] = pixel.color();
                depth_m[column] = f64::from(pixel.depth_m) as f32;
                reads[column] = pixel.reads();
            }
        },
    );
    (Cast::new(image, reads), picture)
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
