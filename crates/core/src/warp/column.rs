//! Layers between the pixels of a picture.

use super::medium::optical_depth;
use super::{EmissionAbsorption, MOST_LAYERS};
use crate::cast::SATURATED_ALPHA;
use crate::view::{RayField, View};
use glam::{DAffine3, DVec2, DVec4, Vec4};
use rayon::prelude::*;

/// How steep a surface may be, in depth per width: beyond it neighbouring columns show different surfaces.
const STEEPEST: f64 = 32.0;

/// Least that is taken to pass layers.
const LEAST_THROUGH: f64 = 1.0 - SATURATED_ALPHA as f64;

/// What is at a position of the picture in a layer.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Stratum {
    /// Depths between which it is, metres.
    pub(super) start_m: f64,
    /// See above.
    pub(super) end_m: f64,
    /// What it adds to the picture of the shown view: premultiplied colour, less what layers before it take.
    pub(super) color: DVec4,
    /// Absorption, 1/m.
    pub(super) absorption_per_m: f64,
}

impl Stratum {
    pub(super) fn is_clear(&self) -> bool {
        self.absorption_per_m <= 0.0
    }

    /// The same, or, if it is clear, nothing where another one is.
    pub(super) fn or_clear_at(&self, other: &Self) -> Self {
        if self.is_clear() {
            Self { start_m: other.start_m, end_m: other.end_m, ..Self::default() }
        } else {
            *self
        }
    }
}

/// The layers at a position of the picture, from the front.
#[derive(Default)]
pub(super) struct Column {
    pub(super) strata: [Stratum; MOST_LAYERS],
}

impl Column {
    /// Opacity of all layers together.
    pub(super) fn alpha(&self) -> f64 {
        self.strata.iter().map(|stratum| stratum.color.w).sum()
    }

    fn weighted(&self, weight: f64) -> Self {
        Self { strata: self.strata.map(|stratum| Stratum { color: weight * stratum.color, ..stratum }) }
    }
}

/// The layers of a picture, ready for being read anywhere.
pub(super) struct Columns<'a> {
    layers: &'a EmissionAbsorption,
    /// What each layer adds to the picture.
    added: Vec<Vec4>,
    /// Rays of the shown view, world space.
    rays: RayField,
    /// Widths of a pixel per metre of depth.
    pixel_tangent: f64,
}

impl<'a> Columns<'a> {
    /// Layers of a view of as many pixels.
    pub(super) fn new(layers: &'a EmissionAbsorption, view: &View) -> Self {
        let rays = RayField::new(view, DAffine3::IDENTITY);
        let [width, count] = [view.size[0] as usize, layers.layer_count()];
        let added = layers.layers().par_chunks_exact(count).enumerate().flat_map_iter(|(pixel, layers)| {
            let (x, y) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
            let metres_per_depth = rays.at(x, y).1.length();
            layers.iter().scan(1.0, move |through, layer| {
                let color = layer.color(metres_per_depth);
                let added = *through * color;
                *through *= 1.0 - color.w;
                Some(added.as_vec4())
            })
        });
        Self { layers, added: added.collect(), rays, pixel_tangent: rays.direction_dx.length() }
    }

    pub(super) fn layer_count(&self) -> usize {
        self.layers.layer_count()
    }

    /// Width and height, pixels.
    pub(super) fn size_px(&self) -> DVec2 {
        DVec2::from(self.layers.size().map(f64::from))
    }

    /// Whether two strata so many pixels apart may be of one sheet.
    pub(super) fn agree(&self, a: &Stratum, b: &Stratum, apart_px: f64) -> bool {
        let gap_m = a.start_m.max(b.start_m) - a.end_m.min(b.end_m);
        gap_m <= STEEPEST * self.pixel_tangent * a.start_m.min(b.start_m) * apart_px.max(1.0)
    }

    /// Interpolates the layers of the four pixels about a position, in pixels from the top left. What a layer adds to the
    /// picture is interpolated, so that all layers together are as opaque as an interpolated picture, however each pixel's
    /// opacity is divided among them; its depths are those of the pixel that has most of it and of others that agree.
    pub(super) fn at(&self, position: DVec2) -> Column {
        let (at, last) = (self.within(position), self.size_px() - 1.0);
        let low = at.floor();
        let along = at - low;
        let high = (low + 1.0).min(last);
        let above = self.united(
            &self.part(low, (1.0 - along.x) * (1.0 - along.y)),
            &self.part(DVec2::new(high.x, low.y), along.x * (1.0 - along.y)),
        );
        let below = self.united(
            &self.part(DVec2::new(low.x, high.y), (1.0 - along.x) * along.y),
            &self.part(high, along.x * along.y),
        );
        self.absorbing(self.united(&above, &below), position)
    }

    /// Interpolates between a column and the layers at the middle of a pixel along an axis, by a share of the way there.
    pub(super) fn between(&self, before: &Column, position: DVec2, axis: DVec2, share: f64) -> Column {
        let (at, last) = (self.within(position), self.size_px() - 1.0);
        let low = (at + 0.5 * axis).floor();
        let along = (at - low).dot(DVec2::ONE - axis);
        let high = (low + DVec2::ONE - axis).min(last);
        let there = self.united(&self.part(low, share * (1.0 - along)), &self.part(high, share * along));
        self.absorbing(self.united(&before.weighted(1.0 - share), &there), position)
    }

    /// Of the middles of pixels, from the first.
    fn within(&self, position: DVec2) -> DVec2 {
        (position - 0.5).clamp(DVec2::ZERO, self.size_px() - 1.0)
    }

    /// What a pixel contributes, by its weight.
    fn part(&self, pixel: DVec2, weight: f64) -> Column {
        let count = self.layer_count();
        let first = (pixel.y as usize * self.layers.size()[0] as usize + pixel.x as usize) * count;
        let layers = self.layers.layers()[first..].iter().zip(&self.added[first..]);
        let mut column = Column::default();
        for (stratum, (layer, added)) in column.strata[..count].iter_mut().zip(layers) {
            *stratum = Stratum {
                start_m: f64::from(layer.start_m),
                end_m: f64::from(layer.end_m),
                color: weight * added.as_dvec4(),
                absorption_per_m: 0.0,
            };
        }
        column
    }

    /// Two columns together. Depths are those of the one that has more of a layer, and of the other if it agrees.
    fn united(&self, first: &Column, second: &Column) -> Column {
        let mut column = Column::default();
        for (stratum, (a, b)) in column.strata.iter_mut().zip(first.strata.iter().zip(&second.strata)) {
            let do_agree = self.agree(a, b, 1.0);
            let has_less = a.color.w < b.color.w;
            let a_weight = if has_less && !do_agree { 0.0 } else { a.color.w };
            let b_weight = if !has_less && !do_agree { 0.0 } else { b.color.w };
            let share = b_weight / (a_weight + b_weight).max(f64::MIN_POSITIVE);
            *stratum = Stratum {
                start_m: a.start_m + share * (b.start_m - a.start_m),
                end_m: a.end_m + share * (b.end_m - a.end_m),
                color: a.color + b.color,
                absorption_per_m: 0.0,
            };
        }
        column
    }

    /// A column and what it absorbs at a position.
    fn absorbing(&self, mut column: Column, position: DVec2) -> Column {
        let metres_per_depth = self.rays.at(position.x, position.y).1.length();
        let mut through = 1.0;
        for stratum in column.strata.iter_mut().filter(|stratum| stratum.color.w > 0.0) {
            let length_m = (stratum.end_m - stratum.start_m) * metres_per_depth;
            stratum.absorption_per_m = optical_depth(stratum.color.w / through) / length_m;
            through = (through - stratum.color.w).max(LEAST_THROUGH);
        }
        column
    }
}
