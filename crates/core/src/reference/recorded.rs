//! Pictures whose rays leave more than their pixel, ray by ray in double precision.

use super::accumulate::Pixels;
use super::context::Context;
use super::lanes_exact::Exact;
use super::ray::{PixelRay, Ray, pixels_of_box};
use super::renderer::{Cast, Reads};
use crate::image::Image;
use crate::view::{RayField, View};
use rayon::prelude::*;

/// Casts the rays of a view, rows in parallel. `rows_left` is what rays leave, row by row of pixels; `cast` gets that of a ray's row, the
/// pixel's column, its middle, and the ray.
pub(super) fn cast_rows<R: Send>(
    context: &Context<'_>,
    view: &View,
    rows_left: impl IndexedParallelIterator<Item = R>,
    cast: impl Fn(&mut R, usize, [f64; 2], &Ray<Exact>) -> Pixels<Exact> + Sync,
) -> Cast {
    let rays = RayField::new(view, context.parameters.texture_from_world);
    let dims = context.sampler.dims().as_dvec3();
    let [columns, rows] = pixels_of_box(view, context.parameters);
    let [width, height] = view.size;
    let mut image = Image::transparent(width, height);
    let mut reads = vec![Reads::default(); image.color.len()];
    let width = width as usize;
    let pictured = image
        .color
        .par_chunks_mut(width)
        .zip(image.depth_m.par_chunks_mut(width))
        .zip(reads.par_chunks_mut(width))
        .zip(rows_left);
    pictured.enumerate().filter(|(row, _)| rows.contains(row)).for_each(
        |(row, (((color, depth_m), reads), mut left))| {
            for column in columns.clone() {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let ray = PixelRay::new(&rays, context.parameters, x, y);
                if ray.sample_count == 0 {
                    continue;
                }
                let pixel = cast(&mut left, column, [x, y], &Ray::new((), dims, &[ray]));
                color[column] = pixel.color();
                depth_m[column] = f64::from(pixel.depth_m) as f32;
                reads[column] = pixel.reads();
            }
        },
    );
    Cast::new(image, reads)
}
