//! Novel views of emission–absorption layers.

use super::column::{Column, Columns, Stratum};
use super::depth_tiles::DepthTiles;
use super::medium::{opacity, optical_depth};
use super::{EmissionAbsorption, PixelMap, WarpError};
use crate::cast::FIRST_HIT_ALPHA;
use crate::image::Image;
use crate::view::{RayField, View};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use rayon::prelude::*;
use std::ops::Range;

/// Most steps that a novel ray can be asked to take.
const MOST_STEPS: u32 = 4096;

/// Times that the depths which a ray may find something at are narrowed to those of the tiles that it passes.
const NARROWINGS: usize = 2;

/// A ray ends when no more than this passes it: casts end so by default.
const LEAST_TRANSMITTANCE: f64 = 0.01;

/// How novel rays are stepped along.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumetricSettings {
    /// Most steps n of a ray, 1 to 4096.
    pub most_steps: u32,
}

impl Default for VolumetricSettings {
    fn default() -> Self {
        Self { most_steps: 32 }
    }
}

impl VolumetricSettings {
    /// Refuses numbers of steps that are none.
    ///
    /// # Errors
    /// Settings out of range.
    pub fn check(&self) -> Result<(), WarpError> {
        if !(1..=MOST_STEPS).contains(&self.most_steps) {
            return Err(WarpError::Steps { steps: self.most_steps, most: MOST_STEPS });
        }
        Ok(())
    }
}

/// What the wanted view sees of the layers of the shown one (VR Alg. 8, after Lochmann et al.).
///
/// Rays step along their epipolar line in the shown picture, by a pixel or so, where one of the tiles that they pass has
/// something; how many steps that is follows from how far the eye has moved, and is at most n. Between two steps each layer
/// is a sheet from one column of the shown picture to the other, where they agree on where it is; so a ray does not slip
/// between the columns of a slanted surface, which loses opacity in Alg. 8. A ray through the middle of a pixel of the shown
/// view itself composites the layers of that pixel.
///
/// Depths are those of the first hit, along the wanted view's −Z. What the shown view did not see stays transparent.
///
/// # Errors
/// Layers of another size than the shown view, a parallel projection, views with numbers that are not finite or without area,
/// settings out of range.
pub fn volumetric(
    layers: &EmissionAbsorption,
    shown: &View,
    wanted: &View,
    settings: &VolumetricSettings,
) -> Result<Image, WarpError> {
    settings.check()?;
    let shown_from_wanted = PixelMap::between(wanted, shown)?;
    if layers.size() != shown.size {
        return Err(WarpError::Mismatch { image: layers.size(), view: shown.size });
    }
    let source = Source { columns: Columns::new(layers, shown), tiles: DepthTiles::new(layers), settings };
    let rays = RayField::new(wanted, DAffine3::IDENTITY);
    let [width, height] = wanted.size;
    let mut image = Image::transparent(width, height);
    let width = width as usize;
    let rows = image.color.par_chunks_mut(width).zip(image.depth_m.par_chunks_mut(width));
    rows.enumerate().for_each(|(row, (color, depth_m))| {
        for column in 0..width {
            let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
            let ray = NovelRay {
                from_eye: shown_from_wanted.epipole,
                per_m: shown_from_wanted.matrix * DVec3::new(x, y, 1.0),
                metres_per_depth: rays.at(x, y).1.length(),
            };
            let light = source.light_along(&ray, rays.depth_range_m);
            color[column] = light.color();
            depth_m[column] = light.depth_m as f32;
        }
    });
    Ok(image)
}

/// A ray of the wanted view: at a depth s of that view, metres, it is at the homogeneous pixel `from_eye + s · per_m` of the
/// shown view, whose z is the depth in the shown view.
struct NovelRay {
    from_eye: DVec3,
    per_m: DVec3,
    /// Length per metre of depth.
    metres_per_depth: f64,
}

/// Where a ray is: pixel and depth in the shown view, depth in the wanted view.
#[derive(Clone, Copy)]
struct Place {
    pixel: DVec2,
    shown_m: f64,
    wanted_m: f64,
}

impl NovelRay {
    fn at(&self, wanted_m: f64) -> Place {
        let point = self.from_eye + wanted_m * self.per_m;
        Place { pixel: point.truncate() / point.z, shown_m: point.z, wanted_m }
    }

    /// The part of an interval of depths within the picture and within a range of depths of the shown view.
    fn clipped(&self, depths_m: &Range<f64>, size: DVec2, shown_m: &Range<f64>) -> Option<Range<f64>> {
        let (from, per) = (self.from_eye, self.per_m);
        let sides = [
            (from.x, per.x),
            (size.x * from.z - from.x, size.x * per.z - per.x),
            (from.y, per.y),
            (size.y * from.z - from.y, size.y * per.z - per.y),
            (from.z - shown_m.start, per.z),
            (shown_m.end - from.z, -per.z),
        ];
        let clipped = sides.into_iter().fold(depths_m.clone(), |depths_m, (a, b)| within(depths_m, a, b));
        (clipped.start < clipped.end && clipped.end.is_finite()).then_some(clipped)
    }
}

/// The part of an interval in which `a + b·s` is not negative.
fn within(Range { start, end }: Range<f64>, a: f64, b: f64) -> Range<f64> {
    let root = -a / b;
    if b > 0.0 {
        start.max(root)..end
    } else if b < 0.0 {
        start..end.min(root)
    } else if a < 0.0 {
        start..start
    } else {
        start..end
    }
}

/// Light of a novel ray, gathered front to back.
struct Light {
    rgb: DVec3,
    transmittance: f64,
    /// Of the first hit in the wanted view, metres; infinite without one.
    depth_m: f64,
}

impl Light {
    fn color(&self) -> [f32; 4] {
        self.rgb.extend(1.0 - self.transmittance).as_vec4().to_array()
    }

    /// Adds a stretch of an optical depth that begins at a depth and takes some, metres.
    fn add(&mut self, rgb: DVec3, optical_depth: f64, start_m: f64, taken_m: f64) {
        let before = self.transmittance;
        self.rgb += rgb * (before * opacity(optical_depth));
        self.transmittance *= (-optical_depth).exp();
        let at_hit = 1.0 - f64::from(FIRST_HIT_ALPHA);
        if self.transmittance <= at_hit && self.depth_m.is_infinite() {
            self.depth_m = start_m + taken_m * (before / at_hit).ln() / optical_depth;
        }
    }
}

/// What a shown view gives.
struct Source<'a> {
    columns: Columns<'a>,
    tiles: DepthTiles,
    settings: &'a VolumetricSettings,
}

impl Source<'_> {
    fn light_along(&self, ray: &NovelRay, (near_m, far_m): (f64, f64)) -> Light {
        let mut light = Light { rgb: DVec3::ZERO, transmittance: 1.0, depth_m: f64::INFINITY };
        let Some([first, last]) = self.stretch(ray, near_m..far_m) else { return light };
        let path = Path::new(first.pixel, last.pixel, self.settings);
        let (mut here, mut here_px) = (first, 0.0);
        let mut column = self.columns.at(first.pixel);
        for step in 1..=path.steps {
            let middle_px = path.middle_px + f64::from(step * path.stride_px);
            let there_px = middle_px.min(path.length_px);
            let fraction = if there_px < path.length_px { there_px / path.length_px } else { 1.0 };
            let there = ray.at(between(&first, &last, fraction));
            let share = (there_px - here_px) / (middle_px - here_px);
            let next = self.columns.between(&column, path.at(middle_px), path.axis, share);
            let segment = Segment {
                ends: [here, there],
                columns: [&column, &next],
                stride_px: f64::from(path.stride_px),
            };
            segment.add_to(&mut light, ray.metres_per_depth, &self.columns);
            if light.transmittance <= LEAST_TRANSMITTANCE {
                break;
            }
            (here, here_px, column) = (there, middle_px, next);
        }
        light
    }

    /// The ends of what a ray may find something on.
    fn stretch(&self, ray: &NovelRay, depths_m: Range<f64>) -> Option<[Place; 2]> {
        let size = self.columns.size_px();
        let mut clipped = ray.clipped(&depths_m, size, &self.tiles.all()?)?;
        for _ in 0..NARROWINGS {
            let [first, last] = [clipped.start, clipped.end].map(|wanted_m| ray.at(wanted_m).pixel);
            clipped = ray.clipped(&clipped, size, &self.tiles.around(first, last)?)?;
        }
        Some([clipped.start, clipped.end].map(|wanted_m| ray.at(wanted_m)))
    }
}

/// The way of a ray in the shown picture, cut where it passes the middles of pixels along the axis that it mostly follows: columns
/// there need the two pixels beside the ray, and within a step what is interpolated between pixels is linear, so that interpolating
/// once more between a step's ends blurs nothing.
struct Path {
    /// Where it begins.
    first: DVec2,
    /// Its change per pixel along the axis.
    per_px: DVec2,
    axis: DVec2,
    /// Its length along the axis, pixels.
    length_px: f64,
    /// From its beginning to the middle of a pixel that is no further on than that.
    middle_px: f64,
    /// Pixels of a step.
    stride_px: u32,
    steps: u32,
}

impl Path {
    fn new(first: DVec2, last: DVec2, settings: &VolumetricSettings) -> Self {
        let way = last - first;
        let axis = if way.x.abs() >= way.y.abs() { DVec2::X } else { DVec2::Y };
        let [from, along] = [first.dot(axis), way.dot(axis)];
        let past_middle = (from - 0.5).rem_euclid(1.0);
        let middle_px = if along < 0.0 && past_middle > 0.0 { past_middle - 1.0 } else { -past_middle };
        let length_px = along.abs();
        let pixels = ((length_px - middle_px).ceil() as u32).max(1);
        let stride_px = pixels.div_ceil(settings.most_steps);
        let per_px = way / length_px.max(f64::MIN_POSITIVE);
        Self { first, per_px, axis, length_px, middle_px, stride_px, steps: pixels.div_ceil(stride_px) }
    }

    /// Where it is, going on in the same direction, so many pixels along the axis from its beginning.
    fn at(&self, along_px: f64) -> DVec2 {
        self.first + along_px * self.per_px
    }
}

/// Depth in the wanted view at a fraction of the way in the shown picture, metres.
fn between(first: &Place, last: &Place, fraction: f64) -> f64 {
    let (a, b) = ((1.0 - fraction) * last.shown_m, fraction * first.shown_m);
    (a * first.wanted_m + b * last.wanted_m) / (a + b)
}

/// A step of a novel ray.
struct Segment<'a> {
    ends: [Place; 2],
    /// At the ends.
    columns: [&'a Column; 2],
    /// Pixels between the columns.
    stride_px: f64,
}

/// A layer along a step: a sheet between the depths at both ends, metres.
struct Sheet {
    starts_m: [f64; 2],
    ends_m: [f64; 2],
    /// At both ends.
    colors: [DVec4; 2],
    absorptions_per_m: [f64; 2],
    /// What all layers together let not through.
    alphas: [f64; 2],
}

impl Sheet {
    /// Of a layer at two positions, and the opacities of all layers there.
    fn between(ends: [&Stratum; 2], alphas: [f64; 2]) -> Self {
        Self {
            starts_m: ends.map(|stratum| stratum.start_m),
            ends_m: ends.map(|stratum| stratum.end_m),
            colors: ends.map(|stratum| stratum.color),
            absorptions_per_m: ends.map(|stratum| stratum.absorption_per_m),
            alphas,
        }
    }

    /// Absorption at a share of the way, 1/m. All layers together are as opaque as the picture is there, interpolated between pixels:
    /// an opaque surface beside nothing ends halfway, where it would still be nearly opaque if absorptions were interpolated.
    fn absorption_per_m(&self, share: f64) -> f64 {
        let optical_depths = self.alphas.map(optical_depth);
        let thinning =
            optical_depth(mix(self.alphas, share)) / mix(optical_depths, share).max(f64::MIN_POSITIVE);
        mix(self.absorptions_per_m, share) * thinning
    }
}

/// A value at a share of the way between two.
fn mix([here, there]: [f64; 2], share: f64) -> f64 {
    here + share * (there - here)
}

impl Segment<'_> {
    /// Composites the layers that the step crosses.
    fn add_to(&self, light: &mut Light, metres_per_depth: f64, columns: &Columns<'_>) {
        let layer_count = columns.layer_count();
        let [alpha, next_alpha] = self.columns.map(Column::alpha);
        let goes_forward = self.ends[0].shown_m <= self.ends[1].shown_m;
        for i in 0..layer_count {
            let i = if goes_forward { i } else { layer_count - 1 - i };
            let [here, there] = self.columns.map(|column| column.strata[i]);
            if here.is_clear() && there.is_clear() {
                continue;
            }
            let (here, there) = (here.or_clear_at(&there), there.or_clear_at(&here));
            let mut add = |sheet: Sheet, part| self.add_sheet(light, metres_per_depth, &sheet, part);
            if columns.agree(&here, &there, self.stride_px) {
                add(Sheet::between([&here, &there], [alpha, next_alpha]), 0.0..1.0);
            } else {
                add(Sheet::between([&here; 2], [alpha; 2]), 0.0..0.5);
                add(Sheet::between([&there; 2], [next_alpha; 2]), 0.5..1.0);
            }
        }
    }

    /// Composites a sheet where a part of the step is in it.
    fn add_sheet(&self, light: &mut Light, metres_per_depth: f64, sheet: &Sheet, part: Range<f64>) {
        let [here, there] = &self.ends;
        let below_start = [here.shown_m - sheet.starts_m[0], there.shown_m - sheet.starts_m[1]];
        let above_end = [sheet.ends_m[0] - here.shown_m, sheet.ends_m[1] - there.shown_m];
        let inside = [below_start, above_end]
            .into_iter()
            .fold(part, |part, [first, last]| within(part, first, last - first));
        if inside.start >= inside.end {
            return;
        }
        let step_m = there.wanted_m - here.wanted_m;
        let length = inside.end - inside.start;
        let taken_m = length * step_m;
        let absorption_per_m = sheet.absorption_per_m(inside.start + 0.5 * length);
        let optical_depth = absorption_per_m * taken_m * metres_per_depth;
        // Where about the middle of what is seen is: halfway through a translucent sheet, at the front of an opaque one.
        let seen_at = inside.start + length / (2.0 + optical_depth);
        let color = sheet.colors[0].lerp(sheet.colors[1], seen_at);
        let rgb = color.truncate() / color.w.max(f64::MIN_POSITIVE);
        light.add(rgb, optical_depth, here.wanted_m + inside.start * step_m, taken_m);
    }
}
