//! Pictures in layers of emission and absorption (VR Alg. 7), ray by ray in double precision.

use super::accumulate::Pixels;
use super::aids::Aids;
use super::classify::{Classify, PreIntegrated, Value, ValueGradient};
use super::composite::{Sample, each_visible};
use super::context::Context;
use super::gathered::Gathered;
use super::lanes::Lanes;
use super::lanes_exact::Exact;
use super::ray::Ray;
use super::recorded::cast_rows;
use super::renderer::{Cast, Caster};
use crate::cast::{CastParameters, Classifier};
use crate::scene::Mode;
use crate::view::{RayField, View};
use crate::warp::{DIVIDED_PX, EmissionAbsorption, Layer, LayerError, LayerThresholds, Medium};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

impl Caster {
    /// Casts a composite in double precision and keeps, besides the picture of [`Caster::cast_exactly`], the layers of its
    /// rays: what [`warp::volumetric`](crate::warp::volumetric) shows from other poses.
    ///
    /// # Errors
    /// Other modes, pictures without pixels, too little memory for the layers.
    pub fn cast_emission_absorption(
        &self,
        parameters: &CastParameters,
        aids: &Aids<'_>,
        view: &View,
        thresholds: &LayerThresholds,
    ) -> Result<(Cast, EmissionAbsorption), LayerError> {
        if parameters.mode != Mode::Composite {
            return Err(LayerError::Mode(parameters.mode));
        }
        let mut layers = EmissionAbsorption::clear(view.size, thresholds.opacities().len())?;
        let context = self.context(parameters, aids);
        let cast = match parameters.classifier {
            Classifier::ValueGradient => cast_view::<ValueGradient>(&context, view, thresholds, &mut layers),
            Classifier::PreIntegrated => cast_view::<PreIntegrated>(&context, view, thresholds, &mut layers),
            Classifier::Value | Classifier::Isovalue => {
                cast_view::<Value>(&context, view, thresholds, &mut layers)
            }
        };
        Ok((cast, layers))
    }
}

fn cast_view<C: Classify>(
    context: &Context<'_>,
    view: &View,
    thresholds: &LayerThresholds,
    layers: &mut EmissionAbsorption,
) -> Cast {
    let world_rays = RayField::new(view, DAffine3::IDENTITY);
    let (width, layer_count) = (view.size[0] as usize, layers.layer_count());
    let rows = layers.layers_mut().par_chunks_mut(width * layer_count);
    cast_rows(context, view, rows, |layers, column, [x, y], ray| {
        let recorder = Recorder {
            thresholds: thresholds.opacities(),
            layers: &mut layers[column * layer_count..][..layer_count],
            metres_per_depth: world_rays.at(x, y).1.length(),
            pixel_width_m: |depth_m: f64| (world_rays.origin_dx + depth_m * world_rays.direction_dx).length(),
            gathered: Gathered::nothing(()),
            span_m: None,
        };
        cast_ray::<C>(context, ray, recorder)
    })
}

fn cast_ray<C: Classify>(
    context: &Context<'_>,
    ray: &Ray<Exact>,
    mut recorder: Recorder<'_, impl Fn(f64) -> f64>,
) -> Pixels<Exact> {
    let least_transmittance = Exact::splat((), 1.0 - context.parameters.termination_alpha);
    let mut gathered = Gathered::nothing(());
    let taken = each_visible::<C, Exact>(context, (), ray, |sample| {
        gathered.add((), sample.rgb, sample.transmittance);
        gathered.note_hit((), gathered.transmittance, ray.depth_m(sample.index));
        recorder.add(ray, &sample, 1.0 - f64::from(gathered.transmittance));
        gathered.transmittance <= least_transmittance
    });
    recorder.end_layer();
    gathered.pixels((), taken)
}

/// Cuts a ray into layers.
struct Recorder<'a, W> {
    /// Of the layers that are not written.
    thresholds: &'a [f32],
    /// Layers that are not written, as many.
    layers: &'a mut [Layer],
    /// Length of the ray per metre of depth.
    metres_per_depth: f64,
    /// Width of a pixel at a depth, metres.
    pixel_width_m: W,
    /// What the layer under way has gathered.
    gathered: Gathered<Exact>,
    /// Depths of the layer under way, metres.
    span_m: Option<[f32; 2]>,
}

impl<W: Fn(f64) -> f64> Recorder<'_, W> {
    /// Adds a sample behind which rays have an opacity.
    fn add(&mut self, ray: &Ray<Exact>, sample: &Sample<Exact>, opacity: f64) {
        if sample.transmittance >= Exact::from(1.0) {
            return;
        }
        let depth_m = |index| f64::from(ray.depth_m(index)) as f32;
        let [begins_m, ends_m] = [-0.5, 0.5].map(|offset| depth_m(sample.index + offset));
        let gap_is_long = |[start_m, end_m]: [f32; 2]| begins_m - end_m > end_m - start_m;
        if self.layers.len() > 1 && self.span_m.is_some_and(gap_is_long) {
            self.end_layer();
        }
        let [start_m, _] = self.span_m.unwrap_or([begins_m; 2]);
        self.span_m = Some([start_m, ends_m]);
        self.gathered.add((), sample.rgb, sample.transmittance);
        let passed = self.thresholds.iter().take_while(|&&y| f64::from(y) <= opacity).count();
        let thickness_m = f64::from(ends_m - start_m) * self.metres_per_depth;
        let is_thick = thickness_m >= DIVIDED_PX * (self.pixel_width_m)(f64::from(ends_m));
        if is_thick && passed > 0 && passed < self.layers.len() {
            self.end_layer();
            self.skip_layers(passed - 1);
        }
    }

    /// Writes the layer under way.
    fn end_layer(&mut self) {
        let Some([start_m, end_m]) = self.span_m.take() else { return };
        let gathered = std::mem::replace(&mut self.gathered, Gathered::nothing(()));
        let [r, g, b] = [gathered.rgb.x, gathered.rgb.y, gathered.rgb.z].map(f64::from);
        let color = DVec3::new(r, g, b).extend(1.0 - f64::from(gathered.transmittance));
        // The depths as they are held, so that rounding them changes no opacity.
        let length_m = (f64::from(end_m) - f64::from(start_m)) * self.metres_per_depth;
        self.layers[0] = Layer { start_m, end_m, medium: Medium::from_color(color, length_m) };
        self.skip_layers(1);
    }

    /// Leaves layers clear.
    fn skip_layers(&mut self, count: usize) {
        self.thresholds = &self.thresholds[count..];
        self.layers = &mut std::mem::take(&mut self.layers)[count..];
    }
}
