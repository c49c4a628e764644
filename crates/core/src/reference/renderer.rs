//! The caster: a volume ready for sampling, and pictures of it.

use super::accumulate::{Accumulate, Composite, FirstHit, Mean, MinIp, Mip, Pixel, XRay};
use super::classify::{Context, PreIntegrated, Value, ValueGradient};
use super::ray::Ray;
use super::volume::{PaddedVoxels, Sampler, Stored};
use crate::cast::{CastParameters, Classifier};
use crate::image::Image;
use crate::scene::Mode;
use crate::view::{RayField, View};
use crate::volume::{Encoding, StorageKind, StoredVoxels, Volume};
use rayon::prelude::*;

/// Side of the square tiles that threads take, pixels: the rays of a tile stay close together in the volume.
const TILE: u32 = 16;

/// A volume held for casting on the CPU.
#[derive(Debug)]
pub struct Caster {
    encoding: Encoding,
    voxels: AnyPadded,
}

#[derive(Debug)]
enum AnyPadded {
    U8(PaddedVoxels<u8>),
    U16(PaddedVoxels<u16>),
    F32(PaddedVoxels<f32>),
}

/// A picture and what it cost.
#[derive(Debug, Clone)]
pub struct Cast {
    /// Colour and depth.
    pub image: Image,
    /// Samples along rays, those of shading not counted.
    pub samples: u64,
}

impl Caster {
    /// Holds a volume at the precision that loses nothing.
    pub fn new(volume: &Volume) -> Self {
        Self::with_storage(volume, StorageKind::lossless_for(volume))
    }

    /// Holds a volume at a given precision.
    pub fn with_storage(volume: &Volume, kind: StorageKind) -> Self {
        let encoding = Encoding::new(volume, kind);
        let dims = volume.grid().dims();
        let voxels = match encoding.encode(volume.voxels(), 0..volume.voxels().len()) {
            StoredVoxels::U8(v) => AnyPadded::U8(PaddedVoxels::new(dims, &v)),
            StoredVoxels::U16(v) => AnyPadded::U16(PaddedVoxels::new(dims, &v)),
            StoredVoxels::F32(v) => AnyPadded::F32(PaddedVoxels::new(dims, &v)),
        };
        Self { encoding, voxels }
    }

    /// Casts every view on all cores.
    pub fn cast(&self, parameters: &CastParameters, views: &[View]) -> Vec<Cast> {
        let map = self.encoding.normalised_from_stored(parameters.window);
        let cast = |view: &View| match &self.voxels {
            AnyPadded::U8(v) => cast_view(Sampler::new(v, map), parameters, view),
            AnyPadded::U16(v) => cast_view(Sampler::new(v, map), parameters, view),
            AnyPadded::F32(v) => cast_view(Sampler::new(v, map), parameters, view),
        };
        views.iter().map(cast).collect()
    }
}

fn cast_view<T: Stored>(sampler: Sampler<'_, T>, parameters: &CastParameters, view: &View) -> Cast {
    let context = Context { sampler, parameters };
    match (parameters.mode, parameters.classifier) {
        (Mode::Composite, Classifier::ValueGradient) => {
            cast_tiles::<Composite<ValueGradient>, T>(&context, view)
        }
        (Mode::Composite, Classifier::PreIntegrated) => {
            cast_tiles::<Composite<PreIntegrated>, T>(&context, view)
        }
        (Mode::Composite, _) => cast_tiles::<Composite<Value>, T>(&context, view),
        (Mode::Mip, _) => cast_tiles::<Mip, T>(&context, view),
        (Mode::MinIp, _) => cast_tiles::<MinIp, T>(&context, view),
        (Mode::Mean, _) => cast_tiles::<Mean, T>(&context, view),
        (Mode::XRay, _) => cast_tiles::<XRay, T>(&context, view),
        (Mode::Isosurface { .. }, _) => cast_tiles::<FirstHit, T>(&context, view),
    }
}

fn cast_tiles<A: Accumulate, T: Stored>(context: &Context<'_, T>, view: &View) -> Cast {
    let rays = RayField::new(view, context.parameters.texture_from_world);
    let [width, height] = view.size;
    let tiles: Vec<(u32, u32)> = (0..height.div_ceil(TILE))
        .flat_map(|row| (0..width.div_ceil(TILE)).map(move |column| (column * TILE, row * TILE)))
        .collect();
    let cast_tile = |&(left, top): &(u32, u32)| -> Vec<(usize, Pixel)> {
        (top..(top + TILE).min(height))
            .flat_map(|y| (left..(left + TILE).min(width)).map(move |x| (x, y)))
            .filter_map(|(x, y)| {
                let ray = Ray::of_pixel(&rays, context.parameters, x, y);
                let pixel_index = y as usize * width as usize + x as usize;
                (ray.sample_count > 0).then(|| (pixel_index, cast_ray::<A, T>(context, &ray)))
            })
            .collect()
    };
    let finished: Vec<Vec<(usize, Pixel)>> = tiles.par_iter().map(cast_tile).collect();
    let mut image = Image::transparent(width, height);
    let mut samples = 0;
    for (index, pixel) in finished.into_iter().flatten() {
        image.color[index] = pixel.color;
        image.depth_m[index] = pixel.depth_m;
        samples += u64::from(pixel.samples);
    }
    Cast { image, samples }
}

fn cast_ray<A: Accumulate, T: Stored>(context: &Context<'_, T>, ray: &Ray) -> Pixel {
    let mut state = A::start(context, ray);
    A::accumulate(context, ray, &mut state);
    A::finish(context, ray, &state)
}
