//! The order in which reference rays are cast.

use super::derived_row::DerivedRow;
use super::splat::{self, Part};
use super::{RayEnd, Reprojection};
use crate::cast::CastParameters;
use crate::image::Image;
use crate::reference::accumulate::Pixels;
use crate::reference::context::Context;
use crate::reference::lanes_exact::Exact;
use crate::reference::ray::{PixelRay, Ray};
use crate::reference::renderer::{Cast, Reads};
use crate::stereo::{Epipolar, Slabs, StereoError};
use crate::view::RayField;
use rayon::prelude::*;
use std::ops::Range;

/// Most columns of rays that are cast: many times as many as a picture has, few enough to end.
const MOST_COLUMNS: usize = 1 << 20;

/// Rays of a reference view in the order that composites the derived view.
pub(super) struct Sweep<'a> {
    epipolar: &'a Epipolar,
    reprojection: Reprojection,
    slabs: Slabs,
    /// Sweep columns of the rays.
    columns: Range<i32>,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(
        parameters: &CastParameters,
        epipolar: &'a Epipolar,
        reprojection: Reprojection,
    ) -> Result<Self, StereoError> {
        let slabs = reprojection.splat.slabs(epipolar);
        let [width, _] = epipolar.reference().size;
        let mut columns = 0..width as i32;
        if let Some(depths_m) = epipolar.depths_m(&parameters.visible_corners_world()) {
            columns = slabs.between(depths_m.start, depths_m.end).cast_columns(width);
            // A sample contributes to columns after the one that its slab gives.
            columns.start = columns.start.saturating_sub(reprojection.splat.column_count() as i32 - 1);
        }
        if columns.len() > MOST_COLUMNS {
            return Err(StereoError::Columns { needed: columns.len(), most: MOST_COLUMNS });
        }
        Ok(Self { epipolar, reprojection, slabs, columns })
    }

    pub(super) fn width(&self) -> usize {
        self.epipolar.reference().size[0] as usize
    }

    pub(super) fn slabs(&self) -> &Slabs {
        &self.slabs
    }

    pub(super) fn ray_end(&self) -> RayEnd {
        self.reprojection.ray_end
    }

    /// The parts of a sample at a depth of a ray, front to back.
    pub(super) fn parts(&self, ray: &Ray<Exact>, depth_m: Exact) -> impl Iterator<Item = Part> + use<> {
        self.reprojection.splat.parts(self.slabs, depth_m.into(), ray.step_depth_m.into())
    }

    /// What the columns of a slab take of samples that are at a depth in the mean.
    pub(super) fn shares(&self, slab: i32, depth_m: Exact) -> [f64; splat::MOST_COLUMNS] {
        self.reprojection.splat.shares(self.slabs, slab, depth_m.into())
    }

    /// Derived columns that samples of a reference column in a slab contribute to, with the number of the share.
    pub(super) fn targets(&self, column: i32, slab: i32) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (first, width) = (i64::from(column) - i64::from(slab), self.width() as i64);
        (0..self.reprojection.splat.column_count())
            .map(move |i| (first + i as i64, i))
            .filter(move |(target, _)| (0..width).contains(target))
            .map(|(target, i)| (target as usize, i))
    }

    /// Derived columns that samples of a reference column contribute to, from one slab to a further one.
    pub(super) fn targets_between(&self, column: i32, nearest: i32, furthest: i32) -> Range<usize> {
        let within = |target: i64| target.clamp(0, self.width() as i64) as usize;
        let column = i64::from(column);
        let end = column - i64::from(furthest) + self.reprojection.splat.column_count() as i64;
        within(column - i64::from(nearest))..within(end)
    }

    /// Casts all rows.
    pub(super) fn cast<R: DerivedRow>(&self, context: &Context<'_>) -> [Cast; 2] {
        let view = self.epipolar.reference();
        let rays = RayField::new(view, context.parameters.texture_from_world);
        let (reference, derived): (Vec<Cast>, Vec<Cast>) =
            (0..view.size[1]).into_par_iter().map(|row| self.cast_row::<R>(context, &rays, row)).unzip();
        [stacked(reference, view.size), stacked(derived, view.size)]
    }

    /// One row of the reference picture and of the derived one.
    fn cast_row<R: DerivedRow>(&self, context: &Context<'_>, rays: &RayField, row: u32) -> (Cast, Cast) {
        let view = self.epipolar.reference();
        let dims = context.sampler.dims().as_dvec3();
        let mut reference = transparent(view.size[0], 1);
        let mut derived = reference.clone();
        let mut derived_row = R::empty(context, self);
        for column in self.columns.clone().rev() {
            let in_picture = self.epipolar.sweep_column(column);
            let (x, y) = (f64::from(in_picture) + 0.5, f64::from(row) + 0.5);
            let ray = PixelRay::new(rays, context.parameters, x, y);
            let is_beyond = !(0..self.width() as i32).contains(&in_picture);
            let depths_m = self.slabs.depths_within_m(column, view.size[0]);
            let ray = if is_beyond { ray.until(depths_m.end) } else { ray };
            if ray.sample_count == 0 {
                continue;
            }
            let pixel = derived_row.cast(context, self, &Ray::new((), dims, &[ray]), column);
            let reads = pixel.reads();
            let cast = if is_beyond { &mut derived } else { &mut reference };
            cast.samples += u64::from(reads.samples);
            cast.map_reads += u64::from(reads.map_reads);
            if !is_beyond {
                set_pixel(&mut reference.image, in_picture as usize, &pixel);
                reference.reads[in_picture as usize] = reads;
            }
        }
        for (column, pixel) in derived_row.pixels(context).iter().enumerate() {
            let in_picture = self.epipolar.sweep_column(column as i32);
            set_pixel(&mut derived.image, in_picture as usize, pixel);
        }
        (reference, derived)
    }
}

fn transparent(width: u32, height: u32) -> Cast {
    let image = Image::transparent(width, height);
    let reads = vec![Reads::default(); image.color.len()];
    Cast::new(image, reads)
}

fn set_pixel(image: &mut Image, at: usize, pixel: &Pixels<Exact>) {
    image.color[at] = pixel.color();
    image.depth_m[at] = f64::from(pixel.depth_m) as f32;
}

/// A picture of rows, from the top.
fn stacked(rows: Vec<Cast>, [width, height]: [u32; 2]) -> Cast {
    let (mut samples, mut map_reads, mut reads) = (0, 0, Vec::new());
    let mut image = Image { width, height, color: Vec::new(), depth_m: Vec::new() };
    for row in rows {
        samples += row.samples;
        map_reads += row.map_reads;
        reads.extend(row.reads);
        image.color.extend(row.image.color);
        image.depth_m.extend(row.image.depth_m);
    }
    Cast { image, samples, map_reads, reads }
}
