//! The caster: a volume ready for sampling, and pictures of it.

use super::accumulate::Accumulate;
use super::classify::{PreIntegrated, Value, ValueGradient};
use super::composite::Composite;
use super::context::Context;
use super::extreme_value::{ExtremeValue, Maximum, Minimum};
use super::first_hit::FirstHit;
use super::lanes::{Lanes, MOST_LANES};
use super::lanes_exact::Exact;
use super::ray::{PixelRay, Ray, pixels_of_box};
use super::value_sum::{Mean, ValueSum, XRay};
use super::volume::{PaddedVoxels, Sampler};
use crate::cast::{CastParameters, Classifier};
use crate::image::Image;
use crate::scene::Mode;
use crate::skip::SkipMap;
use crate::view::{RayField, View};
use crate::volume::{Encoding, StorageKind, Volume};
use fearless_simd::{Level, Simd, f32x16};
use rayon::prelude::*;
use std::ops::Range;

/// A volume held for casting on the CPU.
#[derive(Debug)]
pub struct Caster {
    encoding: Encoding,
    voxels: PaddedVoxels,
}

/// A picture and what it cost.
#[derive(Debug, Clone)]
pub struct Cast {
    /// Colour and depth.
    pub image: Image,
    /// Samples along rays, those of shading not counted.
    pub samples: u64,
    /// Reads of the skip map along rays, those of shading not counted.
    pub map_reads: u64,
}

impl Caster {
    /// Holds a volume at the precision that loses nothing.
    pub fn new(volume: &Volume) -> Self {
        Self::with_storage(volume, StorageKind::lossless_for(volume))
    }

    /// Holds a volume at a given precision.
    pub fn with_storage(volume: &Volume, kind: StorageKind) -> Self {
        let encoding = Encoding::new(volume, kind);
        let stored = encoding.encode(volume.voxels(), 0..volume.voxels().len());
        let voxels = PaddedVoxels::new(volume.grid().dims(), &stored);
        Self { encoding, voxels }
    }

    /// Casts every view on all cores, sixteen rays at once. A map of what is empty for these settings makes it faster and
    /// changes nothing.
    ///
    /// Ray by ray where the machine has no vectors for it (AVX-512, AVX2, NEON), or for more than 2³² voxels.
    pub fn cast(&self, parameters: &CastParameters, skip: Option<&SkipMap>, views: &[View]) -> Vec<Cast> {
        if u32::try_from(self.voxels.len()).is_err() {
            return self.cast_exactly(parameters, skip, views);
        }
        match Level::new() {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx512(simd) => self.cast_on(Wide(simd), parameters, skip, views),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2(simd) => self.cast_on(Wide(simd), parameters, skip, views),
            #[cfg(target_arch = "aarch64")]
            Level::Neon(simd) => self.cast_on(Wide(simd), parameters, skip, views),
            _ => self.cast_exactly(parameters, skip, views),
        }
    }

    /// Casts every view on all cores, ray by ray in double precision: the truth.
    pub fn cast_exactly(
        &self,
        parameters: &CastParameters,
        skip: Option<&SkipMap>,
        views: &[View],
    ) -> Vec<Cast> {
        self.cast_on(OneByOne, parameters, skip, views)
    }

    fn cast_on(
        &self,
        path: impl Path,
        parameters: &CastParameters,
        skip: Option<&SkipMap>,
        views: &[View],
    ) -> Vec<Cast> {
        let map = self.encoding.normalised_from_stored(parameters.window);
        let context = Context::new(Sampler::new(&self.voxels, map), parameters, skip);
        views.iter().map(|view| cast_view(path, &context, view)).collect()
    }
}

/// Which lanes rays are cast on.
trait Path: Copy + Send + Sync {
    /// Rows of pixels whose rays are cast together.
    fn band_rows(self) -> usize;

    /// Casts the rays of a band.
    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &RayField, band: Band<'_>) -> Reads;
}

#[derive(Clone, Copy)]
struct OneByOne;

impl Path for OneByOne {
    fn band_rows(self) -> usize {
        Exact::PACKET[1]
    }

    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &RayField, band: Band<'_>) -> Reads {
        cast_packets::<A, Exact>((), context, rays, band)
    }
}

#[derive(Clone, Copy)]
struct Wide<S>(S);

impl<S: Simd> Path for Wide<S> {
    fn band_rows(self) -> usize {
        f32x16::<S>::PACKET[1]
    }

    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &RayField, band: Band<'_>) -> Reads {
        self.0.vectorize(
            #[inline(always)]
            || cast_packets::<A, f32x16<S>>(self.0, context, rays, band),
        )
    }
}

/// What rays have read.
#[derive(Clone, Copy, Default)]
struct Reads {
    samples: u64,
    map_reads: u64,
}

/// Neighbouring rows of a picture.
struct Band<'a> {
    top: usize,
    width: usize,
    /// Columns whose rays may hit.
    columns: Range<usize>,
    color: &'a mut [[f32; 4]],
    depth_m: &'a mut [f32],
}

fn cast_view(path: impl Path, context: &Context<'_>, view: &View) -> Cast {
    match (context.parameters.mode, context.parameters.classifier) {
        (Mode::Composite, Classifier::ValueGradient) => {
            cast_bands::<Composite<ValueGradient>>(path, context, view)
        }
        (Mode::Composite, Classifier::PreIntegrated) => {
            cast_bands::<Composite<PreIntegrated>>(path, context, view)
        }
        (Mode::Composite, _) => cast_bands::<Composite<Value>>(path, context, view),
        (Mode::Mip, _) => cast_bands::<ExtremeValue<Maximum>>(path, context, view),
        (Mode::MinIp, _) => cast_bands::<ExtremeValue<Minimum>>(path, context, view),
        (Mode::Mean, _) => cast_bands::<ValueSum<Mean>>(path, context, view),
        (Mode::XRay, _) => cast_bands::<ValueSum<XRay>>(path, context, view),
        (Mode::Isosurface { .. }, _) => cast_bands::<FirstHit>(path, context, view),
    }
}

fn cast_bands<A: Accumulate>(path: impl Path, context: &Context<'_>, view: &View) -> Cast {
    let rays = RayField::new(view, context.parameters.texture_from_world);
    let [width, height] = view.size;
    let mut image = Image::transparent(width, height);
    let (rows, width) = (path.band_rows(), width as usize);
    let [hit_columns, hit_rows] = pixels_of_box(&rays, context.parameters, view.size);
    let bands = image.color.par_chunks_mut(rows * width).zip(image.depth_m.par_chunks_mut(rows * width));
    let reads = bands
        .enumerate()
        .filter(|(i, _)| i * rows < hit_rows.end && (i + 1) * rows > hit_rows.start)
        .map(|(i, (color, depth_m))| {
            let columns = hit_columns.clone();
            path.cast_band::<A>(context, &rays, Band { top: i * rows, width, columns, color, depth_m })
        })
        .reduce(Reads::default, |a, b| Reads {
            samples: a.samples + b.samples,
            map_reads: a.map_reads + b.map_reads,
        });
    Cast { image, samples: reads.samples, map_reads: reads.map_reads }
}

#[inline(always)]
fn cast_packets<A: Accumulate, L: Lanes>(
    token: L::Token,
    context: &Context<'_>,
    rays: &RayField,
    band: Band<'_>,
) -> Reads {
    let [columns, rows] = L::PACKET;
    let dims = context.sampler.dims().as_dvec3();
    let mut reads = Reads::default();
    for left in band.columns.clone().step_by(columns) {
        let mut packet = [PixelRay::default(); MOST_LANES];
        let mut is_hit = false;
        for row in 0..rows.min(band.color.len() / band.width) {
            for column in 0..columns.min(band.width - left) {
                let ray = PixelRay::new(rays, context.parameters, left + column, band.top + row);
                is_hit |= ray.sample_count > 0;
                packet[row * columns + column] = ray;
            }
        }
        if !is_hit {
            continue;
        }
        let pixels = A::cast::<L>(context, token, &Ray::new(token, dims, &packet));
        let [r, g, b] = [pixels.rgb.x, pixels.rgb.y, pixels.rgb.z].map(L::to_array);
        let (alpha, depth_m) = (pixels.alpha.to_array(), pixels.depth_m.to_array());
        let (samples, map_reads) = (pixels.samples.to_array(), pixels.map_reads.to_array());
        for (lane, _) in packet.iter().enumerate().filter(|(_, ray)| ray.sample_count > 0) {
            let pixel = lane / columns * band.width + left + lane % columns;
            band.color[pixel] = [r[lane], g[lane], b[lane], alpha[lane]];
            band.depth_m[pixel] = depth_m[lane];
            reads.samples += samples[lane] as u64;
            reads.map_reads += map_reads[lane] as u64;
        }
    }
    reads
}
