//! The caster: a volume ready for sampling, and pictures of it.

use super::accumulate::Accumulate;
use super::aids::{Aids, Leap};
use super::classify::{PreIntegrated, Value, ValueGradient};
use super::composite::Composite;
use super::context::Context;
use super::extreme_value::{ExtremeValue, Maximum, Minimum};
use super::first_hit::FirstHit;
use super::gathered::Gathered;
use super::gradient_map::HeldGradientMap;
use super::lanes::{Lanes, MOST_LANES};
use super::lanes_exact::Exact;
use super::oracle::Oracle;
use super::ray::{PixelRay, Ray, pixels_of_box};
use super::value_sum::{Mean, ValueSum, XRay};
use super::vector::Vec3;
use super::volume::{PaddedVoxels, Sampler};
use crate::cast::{CastParameters, Classifier};
use crate::first_hits::{FirstHits, RayStarts};
use crate::image::Image;
use crate::scene::Mode;
use crate::view::{RayField, View};
use crate::volume::{Encoding, StorageKind, Volume};
use fearless_simd::{Level, Simd, f32x16};
use glam::DVec3;
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
    /// What each ray has read, in the order of the image's pixels.
    pub reads: Vec<Reads>,
}

/// What a ray has read, for shading not counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Reads {
    /// Samples.
    pub samples: u32,
    /// Reads of the skip map.
    pub map_reads: u32,
}

impl Cast {
    /// A transparent picture whose rays have read nothing.
    pub fn nothing([width, height]: [u32; 2]) -> Self {
        let image = Image::transparent(width, height);
        let reads = vec![Reads::default(); image.color.len()];
        Self { image, samples: 0, map_reads: 0, reads }
    }

    /// A picture whose rays have read what is given.
    pub fn new(image: Image, reads: Vec<Reads>) -> Self {
        let total = |of_ray: fn(&Reads) -> u32| reads.iter().map(|ray| u64::from(of_ray(ray))).sum();
        Self { image, samples: total(|ray| ray.samples), map_reads: total(|ray| ray.map_reads), reads }
    }
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

    /// The value at a place in texture space, in the file's unit, interpolated between voxels; beyond the volume, that of its
    /// nearest place.
    pub fn value_at(&self, point_in_texture: DVec3) -> f64 {
        let sampler = Sampler::new(&self.voxels, (1.0, 0.0));
        let position = point_in_texture * sampler.dims().as_dvec3();
        let [x, y, z] = position.to_array().map(Exact::from);
        self.encoding.value(sampler.stored_at((), Vec3 { x, y, z }).into())
    }

    /// Casts every view on all cores, sixteen rays at once.
    ///
    /// Ray by ray where the machine has no vectors for it (AVX-512, AVX2, NEON), or for more than 2³² voxels.
    ///
    /// # Panics
    /// If rays are to leap by the extremes of another mode.
    pub fn cast(&self, parameters: &CastParameters, aids: &Aids<'_>, views: &[View]) -> Vec<Cast> {
        let of_view = |view: &View| self.cast_behind(parameters, aids, view, Cast::nothing(view.size));
        views.iter().map(of_view).collect()
    }

    /// The same of one view, behind a picture of what is nearer if it is a composite: rays go on with what they have gathered.
    ///
    /// # Panics
    /// As [`Caster::cast`], and if the picture has another size than the view.
    pub fn cast_behind(
        &self,
        parameters: &CastParameters,
        aids: &Aids<'_>,
        view: &View,
        front: Cast,
    ) -> Cast {
        let context = self.context(parameters, aids);
        self.cast_frame(&context, Frame { view, starts: None, front }).cast
    }

    /// The same of one view with nothing in front, whose rays leap to what the last picture saw first, if one is given; and what this
    /// one saw first. Nothing but the view may have changed since the last picture, and nothing is leapt over if the mode has no first
    /// hits. What was missed is told in [`first_hits`](crate::first_hits).
    ///
    /// # Panics
    /// As [`Caster::cast`].
    pub fn cast_leaping(
        &self,
        parameters: &CastParameters,
        aids: &Aids<'_>,
        view: &View,
        last: Option<&FirstHits>,
    ) -> (Cast, FirstHits) {
        let context = self.context(parameters, aids);
        let last = last.filter(|_| parameters.has_first_hits());
        let starts = last.map(|last| last.starts(view, parameters));
        let frame = Frame { view, starts: starts.as_ref(), front: Cast::nothing(view.size) };
        let Seen { cast, visible_from_m } = self.cast_frame(&context, frame);
        (cast, FirstHits::of_pixels(view, parameters, &visible_from_m))
    }

    fn cast_frame(&self, context: &Context<'_>, frame: Frame<'_>) -> Seen {
        if u32::try_from(self.voxels.len()).is_err() {
            return cast_view(OneByOne, context, frame);
        }
        match Level::new() {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx512(simd) => cast_view(Wide(simd), context, frame),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2(simd) => cast_view(Wide(simd), context, frame),
            #[cfg(target_arch = "aarch64")]
            Level::Neon(simd) => cast_view(Wide(simd), context, frame),
            _ => cast_view(OneByOne, context, frame),
        }
    }

    /// Casts every view on all cores, ray by ray in double precision: the truth.
    ///
    /// # Panics
    /// As [`Caster::cast`].
    pub fn cast_exactly(&self, parameters: &CastParameters, aids: &Aids<'_>, views: &[View]) -> Vec<Cast> {
        let context = self.context(parameters, aids);
        views.iter().map(|view| cast_view(OneByOne, &context, Frame::of(view)).cast).collect()
    }

    /// What rays must read at the least, whatever the structure: every visible sample, and one read of a map for each run of
    /// samples that are not, up to the end of the ray. For composites; the picture stays transparent.
    pub fn cast_by_oracle(
        &self,
        parameters: &CastParameters,
        gradient_map: Option<&HeldGradientMap>,
        view: &View,
    ) -> Cast {
        let context = self.context(parameters, &Aids { gradient_map, leap: Leap::Nothing });
        let frame = Frame::of(view);
        let seen = match parameters.classifier {
            Classifier::ValueGradient => cast_bands::<Oracle<ValueGradient>>(OneByOne, &context, frame),
            Classifier::PreIntegrated => cast_bands::<Oracle<PreIntegrated>>(OneByOne, &context, frame),
            Classifier::Value | Classifier::Isovalue => {
                cast_bands::<Oracle<Value>>(OneByOne, &context, frame)
            }
        };
        seen.cast
    }

    pub(super) fn context<'a>(&'a self, parameters: &'a CastParameters, aids: &Aids<'a>) -> Context<'a> {
        let normalised_from_stored = self.encoding.normalised_from_stored(parameters.window);
        let gradient_map = aids.gradient_map.map(|map| map.sampler(normalised_from_stored.0));
        let sampler = Sampler::new(&self.voxels, normalised_from_stored);
        Context::new(sampler, gradient_map, parameters, aids.leap)
    }
}

/// A view that is cast.
struct Frame<'a> {
    view: &'a View,
    /// Where rays start, if not at once.
    starts: Option<&'a RayStarts>,
    /// What is in front.
    front: Cast,
}

impl<'a> Frame<'a> {
    /// With nothing in front and nothing to leap over.
    fn of(view: &'a View) -> Self {
        Self { view, starts: None, front: Cast::nothing(view.size) }
    }
}

/// A picture, and at which depth each pixel's ray saw something first, metres; infinite without it.
struct Seen {
    cast: Cast,
    visible_from_m: Vec<f32>,
}

/// Which lanes rays are cast on.
trait Path: Copy + Send + Sync {
    /// Rows of pixels whose rays are cast together.
    fn band_rows(self) -> usize;

    /// Casts the rays of a band.
    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &Rays<'_>, band: Band<'_>);
}

#[derive(Clone, Copy)]
struct OneByOne;

impl Path for OneByOne {
    fn band_rows(self) -> usize {
        Exact::PACKET[1]
    }

    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &Rays<'_>, band: Band<'_>) {
        cast_packets::<A, Exact>((), context, rays, band);
    }
}

#[derive(Clone, Copy)]
struct Wide<S>(S);

impl<S: Simd> Path for Wide<S> {
    fn band_rows(self) -> usize {
        f32x16::<S>::PACKET[1]
    }

    fn cast_band<A: Accumulate>(self, context: &Context<'_>, rays: &Rays<'_>, band: Band<'_>) {
        self.0.vectorize(
            #[inline(always)]
            || cast_packets::<A, f32x16<S>>(self.0, context, rays, band),
        );
    }
}

/// The rays of a picture.
struct Rays<'a> {
    field: RayField,
    /// Where they start, if not at once.
    starts: Option<&'a RayStarts>,
}

impl Rays<'_> {
    /// That of a pixel.
    #[inline(always)]
    fn of_pixel(&self, parameters: &CastParameters, x: usize, y: usize) -> PixelRay {
        let ray = PixelRay::new(&self.field, parameters, x as f64 + 0.5, y as f64 + 0.5);
        match self.starts {
            Some(starts) => ray.from(starts.of_pixel(x, y)),
            None => ray,
        }
    }
}

/// Neighbouring rows of a picture.
struct Band<'a> {
    top: usize,
    width: usize,
    /// Columns whose rays may hit.
    columns: Range<usize>,
    color: &'a mut [[f32; 4]],
    depth_m: &'a mut [f32],
    visible_from_m: &'a mut [f32],
    reads: &'a mut [Reads],
}

fn cast_view(path: impl Path, context: &Context<'_>, frame: Frame<'_>) -> Seen {
    match (context.parameters.mode, context.parameters.classifier) {
        (Mode::Composite, Classifier::ValueGradient) => {
            cast_bands::<Composite<ValueGradient>>(path, context, frame)
        }
        (Mode::Composite, Classifier::PreIntegrated) => {
            cast_bands::<Composite<PreIntegrated>>(path, context, frame)
        }
        (Mode::Composite, _) => cast_bands::<Composite<Value>>(path, context, frame),
        (Mode::Mip, _) => cast_bands::<ExtremeValue<Maximum>>(path, context, frame),
        (Mode::MinIp, _) => cast_bands::<ExtremeValue<Minimum>>(path, context, frame),
        (Mode::Mean, _) => cast_bands::<ValueSum<Mean>>(path, context, frame),
        (Mode::XRay, _) => cast_bands::<ValueSum<XRay>>(path, context, frame),
        (Mode::Isosurface { .. }, _) => cast_bands::<FirstHit>(path, context, frame),
    }
}

fn cast_bands<A: Accumulate>(path: impl Path, context: &Context<'_>, frame: Frame<'_>) -> Seen {
    let Frame { view, starts, front: Cast { mut image, mut reads, .. } } = frame;
    let field = RayField::new(view, context.parameters.texture_from_world);
    let mut visible_from_m = vec![f32::INFINITY; reads.len()];
    assert_eq!([image.width, image.height], view.size, "the picture in front has the size of the view");
    let (rows, width) = (path.band_rows(), image.width as usize);
    let [hit_columns, hit_rows] = pixels_of_box(view, context.parameters);
    let rays = Rays { field, starts };
    let bands = image
        .color
        .par_chunks_mut(rows * width)
        .zip(image.depth_m.par_chunks_mut(rows * width))
        .zip(visible_from_m.par_chunks_mut(rows * width))
        .zip(reads.par_chunks_mut(rows * width));
    bands.enumerate().filter(|(i, _)| i * rows < hit_rows.end && (i + 1) * rows > hit_rows.start).for_each(
        |(i, (((color, depth_m), visible_from_m), reads))| {
            let columns = hit_columns.clone();
            let band = Band { top: i * rows, width, columns, color, depth_m, visible_from_m, reads };
            path.cast_band::<A>(context, &rays, band);
        },
    );
    Seen { cast: Cast::new(image, reads), visible_from_m }
}

#[inline(always)]
fn cast_packets<A: Accumulate, L: Lanes>(
    token: L::Token,
    context: &Context<'_>,
    rays: &Rays<'_>,
    band: Band<'_>,
) {
    let [columns, rows] = L::PACKET;
    let dims = context.sampler.dims().as_dvec3();
    for left in band.columns.clone().step_by(columns) {
        let mut packet = [PixelRay::default(); MOST_LANES];
        let mut front = [([0.0; 4], f32::INFINITY); MOST_LANES];
        let mut is_hit = false;
        for row in 0..rows.min(band.color.len() / band.width) {
            for column in 0..columns.min(band.width - left) {
                let ray = rays.of_pixel(context.parameters, left + column, band.top + row);
                is_hit |= ray.sample_count > 0;
                let (lane, pixel) = (row * columns + column, row * band.width + left + column);
                packet[lane] = ray;
                front[lane] = (band.color[pixel], band.depth_m[pixel]);
            }
        }
        if !is_hit {
            continue;
        }
        let ray = Ray::new(token, dims, &packet);
        let pixels = A::cast::<L>(context, token, &ray, Gathered::of(token, &front));
        let [r, g, b] = [pixels.rgb.x, pixels.rgb.y, pixels.rgb.z].map(L::to_array);
        let (alpha, depth_m) = (pixels.alpha.to_array(), pixels.depth_m.to_array());
        let visible_from_m = pixels.visible_from_m.to_array();
        let (samples, map_reads) = (pixels.taken.samples.to_array(), pixels.taken.map_reads.to_array());
        for (lane, _) in packet.iter().enumerate().filter(|(_, ray)| ray.sample_count > 0) {
            let pixel = lane / columns * band.width + left + lane % columns;
            band.color[pixel] = [r[lane], g[lane], b[lane], alpha[lane]];
            band.depth_m[pixel] = depth_m[lane];
            band.visible_from_m[pixel] = visible_from_m[lane];
            band.reads[pixel].samples += samples[lane] as u32;
            band.reads[pixel].map_reads += map_reads[lane] as u32;
        }
    }
}
