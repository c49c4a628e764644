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
    /// What the ray itself gathers of them.
    gathered: Gathered<Exact>,
    /// Sum of their depths, each by what it adds to the opacity, metres.
    moment_m: Exact,
}

impl Segment {
    fn nothing(slab: i32) -> Self {
        Self { slab, gathered: Gathered::nothing(()), moment_m: Exact::from(0.0) }
    }

    fn alpha(&self) -> Exact {
        Exact::from(1.0) - self.gathered.transmittance
    }

    /// Puts a sample behind those before.
    fn add(&mut self, rgb: Vec3<Exact>, transmittance: Exact, depth_m: Exact) {
        let alpha = self.alpha();
        self.gathered.add((), rgb, transmittance);
        self.moment_m += (self.alpha() - alpha) * depth_m;
    }

    /// What passes in each column that the samples contribute to. In the second one the segment of the ray before is in front: as
    /// much passes both as passes each of them alone.
    fn transmittances(&self, sweep: &Sweep<'_>) -> [Exact; MOST_COLUMNS] {
        let one = Exact::from(1.0);
        if self.alpha() <= Exact::from(0.0) {
            return [one; MOST_COLUMNS];
        }
        let [first, second] = sweep.shares(self.slab, self.moment_m / self.alpha()).map(Exact::from);
        let in_front = self.alpha() * first;
        let left = (one - in_front).max(Exact::from(LEAST_TRANSMITTANCE));
        [
            if first == one { self.gathered.transmittance } else { one - in_front },
            one - self.alpha() * second / left,
        ]
    }

    /// Premultiplied colour in a column: the ray's, by the column's opacity.
    fn rgb(&self, transmittance: Exact) -> Vec3<Exact> {
        if self.alpha() <= Exact::from(0.0) {
            return self.gathered.rgb;
        }
        self.gathered.rgb * ((Exact::from(1.0) - transmittance) / self.alpha())
    }
}

/// Of what passes in front, if something behind is to be seen.
const LEAST_TRANSMITTANCE: f64 = 1.0 / 16_777_216.0;

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
                self.add(sweep, column, &mut segment, &sample, part.share, depth_m);
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
    /// Adds a part of a sample to a segment, if any of its pixels has not ended, and notes where they are hit.
    fn add(
        &mut self,
        sweep: &Sweep<'_>,
        column: i32,
        segment: &mut Segment,
        sample: &Sample<Exact>,
        share: f64,
        depth_m: Exact,
    ) {
        if !self.is_open_here(sweep, column, segment) {
            return;
        }
        segment.add(sample.rgb, (sample.log2 * Exact::from(share)).exp2(), depth_m);
        let transmittances = segment.transmittances(sweep);
        for (target, i) in sweep.targets(column, segment.slab) {
            let pixel = &mut self.pixels[target];
            pixel.note_hit((), pixel.transmittance * transmittances[i], depth_m);
        }
    }

    /// Composites a segment behind what its pixels have gathered.
    fn composite(&mut self, sweep: &Sweep<'_>, column: i32, segment: &Segment) {
        let transmittances = segment.transmittances(sweep);
        for (target, i) in sweep.targets(column, segment.slab) {
            let pixel = &mut self.pixels[target];
            if self.least_transmittance < pixel.transmittance {
                pixel.rgb = segment.rgb(transmittances[i]).mul_add(pixel.transmittance, pixel.rgb);
                pixel.transmittance *= transmittances[i];
            }
        }
    }

    /// Whether any pixel of a segment has not ended.
    fn is_open_here(&self, sweep: &Sweep<'_>, column: i32, segment: &Segment) -> bool {
        let transmittances = segment.transmittances(sweep);
        sweep.targets(column, segment.slab).any(|(target, i)| {
            self.least_transmittance < self.pixels[target].transmittance * transmittances[i]
        })
    }

    /// Whether a ray meets a pixel that has not ended, from its segment on.
    fn is_any_open(&self, sweep: &Sweep<'_>, column: i32, segment: &Segment, last_slab: i32) -> bool {
        self.is_open_here(sweep, column, segment)
            || sweep
                .targets_between(column, segment.slab - 1, last_slab)
                .any(|target| self.least_transmittance < self.pixels[target].transmittance)
    }
}
