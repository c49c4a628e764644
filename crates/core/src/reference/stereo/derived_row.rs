//! Rows of derived pictures.

use super::sweep::Sweep;
use crate::reference::accumulate::Pixels;
use crate::reference::context::Context;
use crate::reference::lanes_exact::Exact;
use crate::reference::ray::Ray;

/// A row of a derived picture that reference rays fill, in sweep columns.
pub(super) trait DerivedRow {
    /// Without a contribution.
    fn empty(context: &Context<'_>, sweep: &Sweep<'_>) -> Self;

    /// Casts the ray of a reference column, which may be beyond the edges, and gives its samples to the row's pixels.
    /// Returns the ray's own pixel.
    fn cast(
        &mut self,
        context: &Context<'_>,
        sweep: &Sweep<'_>,
        ray: &Ray<Exact>,
        column: i32,
    ) -> Pixels<Exact>;

    /// The finished pixels; they have taken nothing themselves.
    fn pixels(&self, context: &Context<'_>) -> Vec<Pixels<Exact>>;
}
