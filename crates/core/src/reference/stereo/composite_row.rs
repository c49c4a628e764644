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
use std::marker::PhantomData;

/// A row whose pixels composite the segments of reference rays front to back.
pub(super) struct CompositeRow<C> {
    pixels: Vec<Gathered<Exact>>,
    /// At this a pixel has ended.
    least_transmittance: Exact,
    classify: PhantomData<C>,
}

/// The samples of a ray in one slab, for each column that they contribute to.
struct Segment {
    slab: i32,
    gathered: [Gathered<Exact>; MOST_COLUMNS],
}

impl Segment {
    fn nothing(slab: i32) -> Self {
        Self { slab, gathered: [Gathered::nothing(()); MOST_COLUMNS] }
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
        for (target, i) in sweep.targets(column, segment.slab) {
            let (pixel, gathered) = (&mut self.pixels[target], &mut segment.gathered[i]);
            if self.least_transmittance < pixel.transmittance * gathered.transmittance {
                gathered.add((), sample.rgb, (sample.log2 * Exact::from(shares[i])).exp2());
                pixel.note_hit((), pixel.transmittance * gathered.transmittance, depth_m);
            }
        }
    }

    /// Composites a segment behind what its pixels have gathered.
    fn composite(&mut self, sweep: &Sweep<'_>, column: i32, segment: &Segment) {
        for (target, i) in sweep.targets(column, segment.slab) {
            let (pixel, gathered) = (&mut self.pixels[target], &segment.gathered[i]);
            pixel.rgb = gathered.rgb.mul_add(pixel.transmittance, pixel.rgb);
            pixel.transmittance *= gathered.transmittance;
        }
    }

    /// Whether a ray meets a pixel that has not ended, from its segment on.
    fn is_any_open(&self, sweep: &Sweep<'_>, column: i32, segment: &Segment, last_slab: i32) -> bool {
        let is_open = |transmittance: Exact| self.least_transmittance < transmittance;
        let is_open_here = sweep.targets(column, segment.slab).any(|(target, i)| {
            is_open(self.pixels[target].transmittance * segment.gathered[i].transmittance)
        });
        is_open_here
            || sweep
                .targets_between(column, segment.slab - 1, last_slab)
                .any(|target| is_open(self.pixels[target].transmittance))
    }
}
