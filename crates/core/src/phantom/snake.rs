//! A coiled snake: faint flesh and skin around a skull, vertebrae and ribs.
//!
//! The body follows a rising spiral about the vertical axis. A point is described by the nearest turn of the spiral:
//! the length along it, and two coordinates across it (outwards and up).

use super::shape::{ellipsoid_distance, filled, sheet};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The spiral: `radius = OUTER − SHRINK·θ`, `z = BOTTOM + RISE·θ` for θ from 0 (tail) to `END` (neck).
const OUTER: f64 = 0.42;
const SHRINK: f64 = 0.115 / TAU;
const BOTTOM: f64 = 0.12;
const RISE: f64 = 0.19 / TAU;
const END: f64 = 3.1 * TAU;

const BODY_RADIUS: f64 = 0.056;
/// Flesh and skin stay at or below the value 0.3, and their gradient below 0.06 per voxel at 256³.
const FLESH: f64 = 0.15;
const SKIN: f64 = 0.30;
const SKIN_WIDTH: f64 = 0.024;
const BONE: f64 = 0.85;
const BONE_EDGE: f64 = 0.009;
const VERTEBRA_SPACING: f64 = 0.042;
const VERTEBRA_RADIUS: f64 = 0.0265;
const RIB_RADIUS: f64 = 0.0030;

pub(super) fn value(point: DVec3) -> f64 {
    let p = point - DVec3::new(0.5, 0.5, 0.0);
    let axis_distance = p.x.hypot(p.y);
    let angle = p.y.atan2(p.x).rem_euclid(TAU);
    let mut value = head(p);
    for turn in 0..4 {
        let theta = (angle + f64::from(turn) * TAU).min(END);
        let missing = (angle + f64::from(turn) * TAU - theta) * axis_distance;
        let across = DVec2::new(axis_distance - (OUTER - SHRINK * theta), p.z - (BOTTOM + RISE * theta));
        let distance = across.length().hypot(missing);
        if distance < BODY_RADIUS {
            let length = OUTER * theta - 0.5 * SHRINK * theta * theta;
            value = value.max(body(across, distance, length));
        }
    }
    value
}

/// Radius of the body at a length from the tail's tip.
fn body_radius(length: f64) -> f64 {
    BODY_RADIUS * (length / 1.2).clamp(0.0, 1.0).sqrt()
}

fn body(across: DVec2, distance: f64, length: f64) -> f64 {
    let radius = body_radius(length);
    if distance > radius {
        return 0.0;
    }
    flesh(distance - radius).max(skeleton(across, length, radius / BODY_RADIUS))
}

/// Skin rises from the surface inwards, then falls to the flesh's level.
fn flesh(signed_distance: f64) -> f64 {
    let rise = SKIN * (-signed_distance / SKIN_WIDTH).clamp(0.0, 1.0);
    let fall = SKIN - (SKIN - FLESH) * (-signed_distance / SKIN_WIDTH - 1.0).clamp(0.0, 1.0);
    rise.min(fall)
}

/// Vertebrae in a row above the middle, each with a spine and a pair of ribs that reach around the flesh.
fn skeleton(across: DVec2, length: f64, scale: f64) -> f64 {
    if scale < 0.25 {
        return 0.0;
    }
    let along = (length / VERTEBRA_SPACING).fract() * VERTEBRA_SPACING - 0.5 * VERTEBRA_SPACING;
    let column = DVec2::new(0.0, 0.018 * scale);
    let radii =
        DVec3::new(0.48 * VERTEBRA_SPACING, VERTEBRA_RADIUS, VERTEBRA_RADIUS) * DVec3::new(1.0, scale, scale);
    let from_column = across - column;
    let centrum = ellipsoid_distance(DVec3::new(along, from_column.x, from_column.y), radii);
    let spine = from_column
        .x
        .abs()
        .max(along.abs() - 0.006)
        .max((from_column.y - 0.012 * scale).abs() - 0.012 * scale);
    // Ribs lie on a circle about the body's middle and lean back as they go down.
    let down = (-across.y).atan2(across.x.abs());
    let rib_along = along - 0.006 * (down - 0.5);
    let rib = (across.length() - 0.036 * scale).hypot(rib_along) - RIB_RADIUS;
    let open_belly = across.x.abs() < 0.012 * scale && across.y < 0.0;
    let mut bone = filled(centrum, BONE_EDGE).max(filled(spine - 0.0015, BONE_EDGE));
    if !open_belly {
        bone = bone.max(filled(rib, BONE_EDGE));
    }
    BONE * bone
}

/// A skull in flesh at the upper end of the spiral, looking along it.
fn head(p: DVec3) -> f64 {
    let (sin, cos) = END.sin_cos();
    let radius = OUTER - SHRINK * END;
    let neck = DVec3::new(radius * cos, radius * sin, BOTTOM + RISE * END);
    let from_neck = p - neck;
    let (forward, aside) = (DVec3::new(-sin, cos, 0.0), DVec3::new(cos, sin, 0.0));
    let local = DVec3::new(from_neck.dot(forward) - 0.06, from_neck.dot(aside), from_neck.z);
    let skin = ellipsoid_distance(local, DVec3::new(0.10, 0.06, 0.05));
    if skin > 0.0 {
        return 0.0;
    }
    let skull = sheet(ellipsoid_distance(local - DVec3::Z * 0.008, DVec3::new(0.065, 0.034, 0.022)), 0.008);
    let jaw = sheet(
        DVec2::new(
            ellipsoid_distance(local * DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.07, 0.036, 1.0)),
            local.z + 0.026,
        )
        .length(),
        0.008,
    );
    flesh(skin).max(BONE * skull.max(jaw))
}
