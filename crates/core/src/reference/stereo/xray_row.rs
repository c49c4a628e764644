//! X-rayed rows.

use super::derived_row::DerivedRow;
use super::sweep::Sweep;
use crate::reference::accumulate::{Pixels, Taken};
use crate::reference::context::Context;
use crate::reference::lanes::Lanes;
use crate::reference::lanes_exact::Exact;
use crate::reference::ray::Ray;
use crate::reference::value_sum::{Projection, XRay, each_value, pixels};

/// A row whose pixels add values up, in any order.
pub(super) struct XRayRow {
    /// Integral of the values over lengths in voxel lengths, and depth in metres from which on rays are in the visible box;
    /// infinite if none is.
    integrals: Vec<(Exact, Exact)>,
}

impl DerivedRow for XRayRow {
    fn empty(_: &Context<'_>, sweep: &Sweep<'_>) -> Self {
        Self { integrals: vec![(Exact::from(0.0), Exact::from(f64::INFINITY)); sweep.width()] }
    }

    fn cast(
        &mut self,
        context: &Context<'_>,
        sweep: &Sweep<'_>,
        ray: &Ray<Exact>,
        column: i32,
    ) -> Pixels<Exact> {
        let mut sum = Exact::from(0.0);
        let taken = each_value(context, (), ray, |index, value| {
            sum += value;
            let depth_m = ray.depth_m(index);
            for part in sweep.parts(ray, depth_m) {
                let shares = sweep.shares(part.slab, depth_m);
                for (target, i) in sweep.targets(column, part.slab) {
                    self.integrals[target].0 += value * ray.step_length * Exact::from(part.share * shares[i]);
                }
            }
        });
        self.cover(sweep, ray, column);
        let value = XRay::value(context, (), ray, sum);
        pixels(context, (), value, ray.depth_m(Exact::from(0.0)), taken)
    }

    fn pixels(&self, context: &Context<'_>) -> Vec<Pixels<Exact>> {
        let nothing = Taken { samples: Exact::from(0.0), map_reads: Exact::from(0.0) };
        let of_integral = |&(integral, nearest_m): &(Exact, Exact)| {
            let value = integral * context.parameters.xray_scale;
            let mut pixel = pixels(context, (), value, nearest_m, nothing);
            if nearest_m == Exact::from(f64::INFINITY) {
                (pixel.rgb, pixel.alpha) = (pixel.rgb * Exact::from(0.0), Exact::from(0.0));
            }
            pixel
        };
        self.integrals.iter().map(of_integral).collect()
    }
}

impl XRayRow {
    /// Notes where a ray is in the visible box, whether it has samples there or leaps.
    fn cover(&mut self, sweep: &Sweep<'_>, ray: &Ray<Exact>, column: i32) {
        let [enter_m, first_m, leave_m] =
            [Exact::from(-0.5), Exact::from(0.0), ray.sample_count - 0.5].map(|index| ray.depth_m(index));
        let range = sweep.slabs().between(enter_m.into(), leave_m.into());
        for slab in (range.furthest..=range.nearest).rev() {
            let start_m = Exact::from(sweep.slabs().depths_m(slab).start);
            for (target, _) in sweep.targets(column, slab) {
                let nearest_m = &mut self.integrals[target].1;
                *nearest_m = nearest_m.min(first_m.max(start_m));
            }
        }
    }
}
