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
pub(super) struct Column {
    pub(super) strata: [Stratum; MOST_LAYERS],
}

impl Column {
    /// Opacity of all layers together.
    pub(super) fn alpha(&self) -> f64 {
        self.strata.iter().map(|stratum| stratum.color.w).sum()
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
        let corners = self.corners(position);
        let metres_per_depth = self.rays.at(position.x, position.y).1.length();
        let mut column = Column { strata: [Stratum::default(); MOST_LAYERS] };
        let mut through = 1.0;
        for (i, stratum) in column.strata.iter_mut().enumerate().take(self.layer_count()) {
            *stratum = self.joined(&corners.map(|(pixel, weight)| self.part(pixel, i, weight)));
            if stratum.color.w > 0.0 {
                let length_m = (stratum.end_m - stratum.start_m) * metres_per_depth;
                stratum.absorption_per_m = optical_depth(stratum.color.w / through) / length_m;
                through = (through - stratum.color.w).max(LEAST_THROUGH);
            }
        }
        column
    }

    /// Pixels about a position, and how much each counts.
    fn corners(&self, position: DVec2) -> [(usize, f64); 4] {
        let last = self.size_px() - 1.0;
        let at = (position - 0.5).clamp(DVec2::ZERO, last);
        let low = at.floor().min((last - 1.0).max(DVec2::ZERO));
        let along = at - low;
        let high = (low + 1.0).min(last);
        let width = last.x as usize + 1;
        let pixel = |x: f64, y: f64| y as usize * width + x as usize;
        [
            (pixel(low.x, low.y), (1.0 - along.x) * (1.0 - along.y)),
            (pixel(high.x, low.y), along.x * (1.0 - along.y)),
            (pixel(low.x, high.y), (1.0 - along.x) * along.y),
            (pixel(high.x, high.y), along.x * along.y),
        ]
    }

    /// What a pixel contributes to a layer, by its weight.
    fn part(&self, pixel: usize, layer: usize, weight: f64) -> Stratum {
        let at = pixel * self.layer_count() + layer;
        let layer = &self.layers.layers()[at];
        Stratum {
            start_m: f64::from(layer.start_m),
            end_m: f64::from(layer.end_m),
            color: self.added[at].as_dvec4() * weight,
            absorption_per_m: 0.0,
        }
    }

    /// All parts together, where most of it is.
    fn joined(&self, parts: &[Stratum; 4]) -> Stratum {
        let most = parts.iter().max_by(|a, b| a.color.w.total_cmp(&b.color.w)).unwrap_or(&parts[0]);
        if most.color.w <= 0.0 {
            return Stratum::default();
        }
        let (mut color, mut span_m, mut weight) = (DVec4::ZERO, DVec2::ZERO, 0.0);
        for part in parts {
            color += part.color;
            if part.color.w > 0.0 && self.agree(most, part, 1.0) {
                span_m += part.color.w * DVec2::new(part.start_m, part.end_m);
                weight += part.color.w;
            }
        }
        let [start_m, end_m] = (span_m / weight).to_array();
        Stratum { start_m, end_m, color, absorption_per_m: 0.0 }
    }
}
