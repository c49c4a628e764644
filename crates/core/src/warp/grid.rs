//! The picture as a surface of its first hits.

use super::{PixelMap, WarpError};
use crate::image::Image;
use crate::view::View;
use glam::{DVec2, DVec4, Vec4};
use rayon::prelude::*;

/// Most steps of a ray along its epipolar line; they are longer where these would not do.
pub const MOST_GRID_STEPS: u32 = 128;

/// Least change of what a ray is in front of, per pixel that it goes: two surfaces are never quite parallel to it.
const LEAST_SLOPE: f64 = 0.25;

/// What pixels that are torn from what is hit count for: something where there are no others.
const TORN_WEIGHT: f64 = 1e-9;

/// The pixels about a position, from the first.
const CORNERS: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];

/// How [`grid`] treats edges of depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridSettings {
    /// How far apart two neighbouring pixels may move before the surface is torn between them, pixels of the shown picture.
    pub tear_px: f64,
    /// Widest hole that is closed with the colours of its far side, pixels of the shown picture.
    pub close_px: f64,
}

impl Default for GridSettings {
    fn default() -> Self {
        Self { tear_px: 1.0, close_px: 64.0 }
    }
}

impl GridSettings {
    /// Refuses distances that are none.
    ///
    /// # Errors
    /// Settings below zero or not finite.
    pub fn check(&self) -> Result<(), WarpError> {
        WarpError::unless_distance("distance at which cells tear", self.tear_px)?;
        WarpError::unless_distance("width of holes that are closed", self.close_px)
    }
}

/// The picture of the shown view as the wanted view sees it if each pixel is a piece of surface at its first hit (VR §5.3.2).
/// Pixels without a hit are infinitely far away, so that without any depth, or under a turn, this is [`quad`](super::quad) at infinity.
///
/// Every wanted pixel looks for what its ray meets. At inverse depth q (1/m) in the shown view the ray is at the pixel
/// `s + q·g` of it, where s is where [`quad`](super::quad) at infinity reads and g = `epipole.xy − epipole.z·s` of the [`PixelMap`] from
/// wanted to shown: disparity q·|g| is how far along the epipolar line. From the nearest disparity to none, pixel by pixel, the first
/// pixel whose own disparity is that of the ray or more is hit, if the surface goes on from the one before. If it is torn there, the
/// ray passes behind the near side; what it meets only if that ends is hit all the same, and else it has gone through a hole,
/// which shows the far side's colours, the furthest of several. Colours are bilinear among neighbours that are not torn from what
/// is hit.
///
/// # Errors
/// A picture that is not of the shown view, a parallel projection, views with numbers that are not finite or without area,
/// settings below zero.
pub fn grid(shown: &View, image: &Image, wanted: &View, settings: GridSettings) -> Result<Image, WarpError> {
    let map = PixelMap::between(wanted, shown)?;
    WarpError::unless_of(image, shown)?;
    settings.check()?;
    let nearest = image.depth_m.par_iter().map(|&depth_m| inverse(depth_m)).reduce(|| 0.0, f64::max);
    let surface = Surface { image, map, settings, nearest, near_m: wanted.projection.depth_range_m().0 };
    let [width, height] = wanted.size;
    let mut warped = Image::transparent(width, height);
    let width = width as usize;
    let rows = warped.color.par_chunks_mut(width).zip(warped.depth_m.par_chunks_mut(width));
    rows.enumerate().for_each(|(y, (colors, depths_m))| {
        for (x, (color, depth_m)) in colors.iter_mut().zip(depths_m).enumerate() {
            let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let Some(ray) = surface.ray(centre) else { continue };
            if let Some(hit) = surface.hit(&ray) {
                *color = hit.color.as_vec4().to_array();
                *depth_m = ray.depth_m(hit.inverse_depth) as f32;
            }
        }
    });
    Ok(warped)
}

struct Surface<'a> {
    image: &'a Image,
    /// From wanted to shown.
    map: PixelMap,
    settings: GridSettings,
    /// Largest inverse depth of a pixel, 1/m.
    nearest: f64,
    /// Least depth that the wanted view shows, metres.
    near_m: f64,
}

/// The ray of a wanted pixel in the shown picture.
struct Ray {
    /// Where it comes from infinity, pixels.
    start: DVec2,
    /// Unit vector along its epipolar line; 0 if the ray is at one pixel at every depth.
    along: DVec2,
    /// Disparity, pixels, per inverse depth.
    disparity_m: f64,
    /// Largest inverse depth in front of the wanted view's near plane and of what is in the picture, 1/m.
    nearest: f64,
    /// Depth in the shown view per depth in the wanted one, far away.
    scale: f64,
    /// Depth of the wanted eye in the shown view, metres.
    eye_m: f64,
}

impl Ray {
    fn at(&self, disparity_px: f64) -> DVec2 {
        self.start + disparity_px * self.along
    }

    /// Depth in the wanted view at an inverse depth in the shown one.
    fn depth_m(&self, inverse_depth: f64) -> f64 {
        (1.0 / inverse_depth - self.eye_m) / self.scale
    }
}

/// What a ray meets.
struct Hit {
    color: DVec4,
    /// In the shown view, 1/m.
    inverse_depth: f64,
}

impl Surface<'_> {
    /// The ray through a position of the wanted picture; none if it leads away from all that is far in front of the shown eye.
    fn ray(&self, position: DVec2) -> Option<Ray> {
        let start = self.map.at(position, 0.0)?.position;
        let scale = (self.map.matrix * position.extend(1.0)).z;
        let epipole = self.map.epipole;
        let direction = epipole.truncate() - epipole.z * start;
        let nearest_depth_m = self.near_m * scale + epipole.z;
        let nearest =
            if nearest_depth_m > 0.0 { self.nearest.min(1.0 / nearest_depth_m) } else { self.nearest };
        Some(Ray {
            start,
            along: direction.normalize_or_zero(),
            disparity_m: direction.length(),
            nearest,
            scale,
            eye_m: epipole.z,
        })
    }

    fn hit(&self, ray: &Ray) -> Option<Hit> {
        let GridSettings { tear_px, close_px } = self.settings;
        let furthest_px = ray.nearest * ray.disparity_m;
        let step_px = (furthest_px / f64::from(MOST_GRID_STEPS)).max(1.0);
        let mut at_px = ((furthest_px / step_px).floor() + 1.0) * step_px;
        let mut before_px = self.disparity_px(ray, at_px);
        let mut is_in_front = before_px <= at_px;
        let mut behind_px = f64::INFINITY;
        let mut behind_at_px = 0.0;
        while at_px > 0.0 {
            at_px -= step_px;
            let here_px = self.disparity_px(ray, at_px);
            let rise_px = here_px - before_px;
            let is_reached = here_px >= at_px;
            if is_in_front && is_reached {
                if rise_px <= tear_px * step_px {
                    // Where a straight surface between both would be met.
                    let slope = (1.0 + rise_px / step_px).max(LEAST_SLOPE);
                    let met_px = at_px + ((here_px - at_px) / slope).min(step_px);
                    return Some(self.at(ray, met_px, met_px, slope));
                }
                if rise_px <= close_px && before_px < behind_px {
                    (behind_px, behind_at_px) = (before_px, at_px + step_px);
                }
            }
            is_in_front = !is_reached;
            before_px = here_px;
        }
        behind_px.is_finite().then(|| self.at(ray, behind_at_px, behind_px, f64::INFINITY))
    }

    /// What is about where a ray is at a disparity, bilinear among pixels that are not torn from another disparity. If the
    /// surface there lets the ray come closer at a slope, it is followed to where both meet.
    fn at(&self, ray: &Ray, at_px: f64, disparity_px: f64, slope: f64) -> Hit {
        let position = ray.at(at_px) - 0.5;
        let first = position.floor();
        let corners = CORNERS.map(|corner| first + corner);
        let depths = corners.map(|corner| self.inverse_depth(corner));
        let is_torn =
            depths.map(|depth| (depth * ray.disparity_m - disparity_px).abs() > self.settings.tear_px);
        let weights = |position: DVec2| {
            let along = (position - first).clamp(DVec2::ZERO, DVec2::ONE);
            let weights = [0, 1, 2, 3].map(|i| {
                let weight = (1.0 - along + CORNERS[i] * (2.0 * along - 1.0)).element_product();
                if is_torn[i] { weight * TORN_WEIGHT } else { weight }
            });
            weights.map(|weight| weight / weights.iter().sum::<f64>())
        };
        let depth =
            |weights: [f64; 4]| weights.iter().zip(depths).map(|(weight, depth)| weight * depth).sum();
        let met: f64 = depth(weights(position));
        let weights = weights(ray.at(at_px + (met * ray.disparity_m - at_px) / slope) - 0.5);
        let color = corners.iter().zip(weights).map(|(&corner, weight)| weight * self.color(corner)).sum();
        Hit { color, inverse_depth: depth(weights) }
    }

    /// Of the pixel where a ray is at a disparity.
    fn disparity_px(&self, ray: &Ray, at_px: f64) -> f64 {
        self.inverse_depth(ray.at(at_px).floor()) * ray.disparity_m
    }

    /// Inverse depth of the pixel nearest to one, 1/m.
    fn inverse_depth(&self, pixel: DVec2) -> f64 {
        let last = DVec2::new(f64::from(self.image.width), f64::from(self.image.height)) - 1.0;
        let pixel = pixel.clamp(DVec2::ZERO, last);
        inverse(self.image.depth_m[pixel.y as usize * self.image.width as usize + pixel.x as usize])
    }

    /// Colour of a pixel; transparent outside of the picture.
    fn color(&self, pixel: DVec2) -> DVec4 {
        let is_inside = pixel.min_element() >= 0.0
            && pixel.x < f64::from(self.image.width)
            && pixel.y < f64::from(self.image.height);
        if !is_inside {
            return DVec4::ZERO;
        }
        Vec4::from(self.image.color[pixel.y as usize * self.image.width as usize + pixel.x as usize])
            .as_dvec4()
    }
}

/// One over a depth; 0 for what is no depth in front of the eye.
fn inverse(depth_m: f32) -> f64 {
    if depth_m > 0.0 { 1.0 / f64::from(depth_m) } else { 0.0 }
}
