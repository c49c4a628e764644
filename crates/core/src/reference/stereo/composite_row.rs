//! Composited rows.

use super::derived_row::DerivedRow;
use super::ray_end::RayEnd;
use super::splat::MOST_COLUMNS;
use super::sweep::Sweep;
use crate::reference::accumulate::{Pixels, Taken};
use crate::reference::classify::Classify;
use crate::reference::composite::{Sample, each_visible};
use crate::reference::context::Context;
use crate::reference::gathered::Gathered;
use crate::reference::lanes::Lanes;
use crate::reference::lanes_exact::Exact;
use crate::reference::ray::Ray;
use crate::reference::vector::Vec3;
use std::marker::PhantomData;

/// A row whose pixels composite the segments of reference rays front to back.
pub(super) struct CompositeRow<C> {
    pixels: Vec<Gathered<Exact>>,
    /// At this a pixel has ended.
    least_transmittance: Exact,
    classify: PhantomData<C>,
}

/// The samples of a ray in one slab.
struct Segment {
    slab: i32,
    /// What the ray itself gathers of them. Columns take its colour whatever their shares: a small share of a surface must not
    /// show what is behind it.
    gathered: Gathered<Exact>,
    /// What passes in each column that they contribute to.
    transmittances: [Exact; MOST_COLUMNS],
}

impl Segment {
    fn nothing(slab: i32) -> Self {
        let clear = Exact::splat((), 1.0);
        Self { slab, gathered: Gathered::nothing(()), transmittances: [clear; MOST_COLUMNS] }
    }

    /// Premultiplied colour in a column: the ray's, by the column's opacity.
    fn rgb(&self, i: usize) -> Vec3<Exact> {
        let one = Exact::splat((), 1.0);
        let alpha = one - self.gathered.transmittance;
        if alpha <= Exact::splat((), 0.0) {
            return self.gathered.rgb;
        }
        self.gathered.rgb * ((one - self.transmittances[i]) / alpha)
    }
}

impl<C: Classify> DerivedRow for CompositeRow<C> {
    fn empty(context: &Context<'_>, sweep: &Sweep<'_>) -> Self {
        Self {
            pixels: vec![Gathered::nothing(()); sweep.width()],
            least_transmittance: Exact::splat((), 1.0 - context.parameters.termination_alpha),
            classify: PhantomData,
        }
    }

    fn cast(
        &mut self,
        context: &Context<'_>,
        sweep: &Sweep<'_>,
        ray: &Ray<Exact>,
        column: i32,
    ) -> Pixels<Exact> {
        let slab_at = |index: Exact| sweep.slabs().at(ray.depth_m(index).into());
        let last_slab = slab_at(ray.sample_count - 0.5);
        let mut segment = Segment::nothing(slab_at(Exact::from(0.0)));
        let mut own = Gathered::nothing(());
        let mut has_ended = false;
        let taken = each_visible::<C, Exact>(context, (), ray, |sample| {
            let depth_m = ray.depth_m(sample.index);
            if !has_ended {
                own.add((), sample.rgb, sample.transmittance);
                own.note_hit((), own.transmittance, depth_m);
                has_ended = own.transmittance <= self.least_transmittance;
            }
            for part in sweep.parts(ray, depth_m) {
                if part.slab != segment.slab {
                    self.composite(sweep, column, &segment);
                    segment = Segment::nothing(part.slab);
                }
                self.add(sweep, column, &mut segment, &sample, part.shares, depth_m);
            }
            match sweep.ray_end() {
                RayEnd::Volume => false,
                RayEnd::Reference => has_ended,
                RayEnd::Joint => {
                    let is_in_picture = (0..sweep.width() as i32).contains(&column);
                    (has_ended || !is_in_picture) && !self.is_any_open(sweep, column, &segment, last_slab)
                }
            }
        });
        self.composite(sweep, column, &segment);
        own.pixels((), taken)
    }

    fn pixels(&self, _: &Context<'_>) -> Vec<Pixels<Exact>> {
        let nothing = Taken { samples: Exact::splat((), 0.0), map_reads: Exact::splat((), 0.0) };
        self.pixels.iter().map(|pixel| pixel.pixels((), nothing)).collect()
    }
}

impl<C: Classify> CompositeRow<C> {
    /// Adds a part of a sample to a segment, for pixels that have not ended, and notes where they are hit.
    fn add(
        &mut self,
        sweep: &Sweep<'_>,
        column: i32,
        segment: &mut Segment,
        sample: &Sample<Exact>,
        shares: [f64; MOST_COLUMNS],
        depth_m: Exact,
    ) {
        let part_share = Exact::from(shares.iter().sum::<f64>());
        let mut is_any_open = false;
        for (target, i) in sweep.targets(column, segment.slab) {
            let (pixel, transmittance) = (&mut self.pixels[target], &mut segment.transmittances[i]);
            if self.least_transmittance < pixel.transmittance * *transmittance {
                *transmittance *= (sample.log2 * Exact::from(shares[i])).exp2();
                pixel.note_hit((), pixel.transmittance * *transmittance, depth_m);
                is_any_open = true;
            }
        }
        if is_any_open {
            segment.gathered.add((), sample.rgb, (sample.log2 * part_share).exp2());
        }
    }

    /// Composites a segment behind what its pixels have gathered.
    fn composite(&mut self, sweep: &Sweep<'_>, column: i32, segment: &Segment) {
        for (target, i) in sweep.targets(column, segment.slab) {
            let pixel = &mut self.pixels[target];
            pixel.rgb = segment.rgb(i).mul_add(pixel.transmittance, pixel.rgb);
            pixel.transmittance *= segment.transmittances[i];
        }
    }

    /// Whether a ray meets a pixel that has not ended, from its segment on.
    fn is_any_open(&self, sweep: &Sweep<'_>, column: i32, segment: &Segment, last_slab: i32) -> bool {
        let is_open = |transmittance: Exact| self.least_transmittance < transmittance;
        let is_open_here = sweep
            .targets(column, segment.slab)
            .any(|(target, i)| is_open(self.pixels[target].transmittance * segment.transmittances[i]));
        is_open_here
            || sweep
                .targets_between(column, segment.slab - 1, last_slab)
                .any(|target| is_open(self.pixels[target].transmittance))
    }
}
