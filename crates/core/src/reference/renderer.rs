//! The caster: a volume ready for sampling, and pictures of it.

use super::accumulate::Accumulate;
use super::classify::{PreIntegrated, Value, ValueGradient};
use super::composite::Composite;
use super::context::Context;
use super::extreme_value::{ExtremeValue, Maximum, Minimum};
use super::first_hit::FirstHit;
use super::lanes::Lanes;
use super::lanes_exact::Exact;
use super::ray::{PixelRay, Ray};
use super::value_sum::{Mean, ValueSum, XRay};
use super::volume::{PaddedVoxels, Sampler};
use crate::cast::{CastParameters, Classifier};
use crate::image::Image;
use crate::scene::Mode;
use crate::view::{RayField, View};
use crate::volume::{Encoding, StorageKind, Volume};
use fearless_simd::{Level, Simd, f32x16};
use rayon::prelude::*;

/// Most lanes of a packet.
const MOST_LANES: usize = 16;

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

    /// Casts every view on all cores, sixteen rays at once.
    ///
    /// Ray by ray where the machine has no vectors for it (AVX-512, AVX2, NEON), or for more than 2³² voxels.
    pub fn cast(&self, parameters: &CastParameters, views: &[View]) -> Vec<Cast> {
        if u32::try_from(self.voxels.len()).is_err() {
            return self.cast_exactly(parameters, views);
        }
        match Level::new() {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx512(simd) => self.cast_on(Wide(simd), parameters, views),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2(simd) => self.cast_on(Wide(simd), parameters, views),
            #[cfg(target_arch = "aarch64")]
            Level::Neon(simd) => self.cast_on(Wide(simd), parameters, views),
            _ => self.cast_exactly(parameters, views),
        }
    }

    /// Casts every view on all cores, ray by ray in double precision: the truth.
    pub fn cast_exactly(&self, parameters: &CastParameters, views: &[View]) -> Vec<Cast> {
        self.cast_on(OneByOne, parameters, views)
    }

    fn cast_on(&self, path: impl Path, parameters: &CastParameters, views: &[View]) -> Vec<Cast> {
        let map = self.encoding.normalised_from_stored(parameters.window);
        let context = Context::new(Sampler::new(&self.voxels, map), parameters);
        views.iter().map(|view| cast_view(path, &context, view)).collect()
    }
}

/// Which lanes rays are cast on.
trait Path: Copy + Send + Sync {
    /// Rows of pixels whose rays are cast together.
    fn band_rows(self) -> usize;

    /// Casts the rays of a band; gives the number of samples.
    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &RayField, band: Band<'_>) -> u64;
}

#[derive(Clone, Copy)]
struct OneByOne;

impl Path for OneByOne {
    fn band_rows(self) -> usize {
        Exact::PACKET[1]
    }

    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &RayField, band: Band<'_>) -> u64 {
        cast_packets::<A, Exact>((), context, rays, band)
    }
}

#[derive(Clone, Copy)]
struct Wide<S>(S);

impl<S: Simd> Path for Wide<S> {
    fn band_rows(self) -> usize {
        f32x16::<S>::PACKET[1]
    }

    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &RayField, band: Band<'_>) -> u64 {
        self.0.vectorize(
            #[inline(always)]
            || cast_packets::<A, f32x16<S>>(self.0, context, rays, band),
        )
    }
}

/// Neighbouring rows of a picture.
struct Band<'a> {
    top: usize,
    width: usize,
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
    let bands = image.color.par_chunks_mut(rows * width).zip(image.depth_m.par_chunks_mut(rows * width));
    let samples = bands
        .enumerate()
        .map(|(i, (color, depth_m))| {
            path.cast_band::<A>(context, &rays, Band { top: i * rows, width, color, depth_m })
        })
        .sum();
    Cast { image, samples }
}

#[inline(always)]
fn cast_packets<A: Accumulate, L: Lanes>(
    token: L::Token,
    context: &Context<'_>,
    rays: &RayField,
    band: Band<'_>,
) -> u64 {
    let [columns, rows] = L::PACKET;
    let dims = context.sampler.dims().as_dvec3();
    let mut samples = 0;
    for left in (0..band.width).step_by(columns) {
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
        for (lane, _) in packet.iter().enumerate().filter(|(_, ray)| ray.sample_count > 0) {
            let pixel = lane / columns * band.width + left + lane % columns;
            let [r, g, b] = [pixels.rgb.x, pixels.rgb.y, pixels.rgb.z].map(|channel| channel.lane(lane));
            band.color[pixel] = [r, g, b, pixels.alpha.lane(lane)];
            band.depth_m[pixel] = pixels.depth_m.lane(lane);
            samples += pixels.samples.lane(lane) as u64;
        }
    }
    samples
}
