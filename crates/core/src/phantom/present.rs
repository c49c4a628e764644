//! A gift: nested boxes of soft thin card, a ribbon with a bow, and a ball in the innermost box.

use super::shape::{box_distance, ellipse_distance, filled, sheet};
use glam::{DVec2, DVec3};

const WRAPPING_HALF_SIZE: DVec3 = DVec3::new(0.38, 0.38, 0.29);
const CENTRE: DVec3 = DVec3::new(0.5, 0.5, 0.4);

/// Card is faint and soft, so that its gradient stays below 0.06 per voxel at 256³; ribbon, bow and ball are dense.
const CARD: f64 = 0.13;
const CARD_HALF_WIDTH: f64 = 0.0107;
const RIBBON: f64 = 0.65;
const RIBBON_HALF_WIDTH: f64 = 0.0104;
const RIBBON_HALF_BREADTH: f64 = 0.062;

pub(super) fn value(point: DVec3) -> f64 {
    let p = point - CENTRE;
    let wrapping = box_distance(p, WRAPPING_HALF_SIZE);
    if wrapping > 0.03 {
        return bow(p - DVec3::Z * WRAPPING_HALF_SIZE.z);
    }
    let mut value = CARD * sheet(wrapping, CARD_HALF_WIDTH);
    value = value.max(ribbon(p, wrapping));
    if wrapping < -0.01 {
        value = value.max(CARD * sheet(box_distance(p, 0.86 * WRAPPING_HALF_SIZE), CARD_HALF_WIDTH));
        value = value.max(inner_box(p));
    }
    value.max(bow(p - DVec3::Z * WRAPPING_HALF_SIZE.z))
}

/// Two bands around the wrapping that cross above and below.
fn ribbon(p: DVec3, wrapping: f64) -> f64 {
    let band = filled(p.x.abs().min(p.y.abs()) - RIBBON_HALF_BREADTH, 0.01);
    RIBBON * sheet(wrapping - 0.014, RIBBON_HALF_WIDTH).min(band)
}

/// A turned box with a ball in it.
fn inner_box(p: DVec3) -> f64 {
    let p = p + DVec3::Z * 0.07;
    let turned = DVec3::new(0.94 * p.x + 0.342 * p.y, 0.94 * p.y - 0.342 * p.x, p.z);
    let card = CARD * sheet(box_distance(turned, DVec3::new(0.19, 0.19, 0.15)), CARD_HALF_WIDTH);
    card.max(0.9 * sheet(p.length() - 0.11, RIBBON_HALF_WIDTH))
}

/// Four loops and a knot on the middle of the lid.
fn bow(p: DVec3) -> f64 {
    let folded = DVec2::new(p.x.abs(), p.y.abs());
    let (along, across) = (folded.max_element(), folded.min_element());
    let ring = ellipse_distance(DVec2::new(along - 0.115, p.z - 0.075), DVec2::new(0.105, 0.055));
    let breadth = filled(across - 0.3 * along.min(0.15) - 0.01, 0.01);
    let loops = sheet(ring, RIBBON_HALF_WIDTH).min(breadth);
    let knot = sheet((p - DVec3::Z * 0.055).length() - 0.035, RIBBON_HALF_WIDTH);
    RIBBON * loops.max(knot)
}
