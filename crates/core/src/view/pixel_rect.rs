//! The part of a picture that a body can cover.

use super::{Frustum, Mcop, OrthographicBox, Projection, View};
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Pixels added on each side, for rays that rounding moves.
const MARGIN: f64 = 1.0;

/// A rectangle of pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PixelRect {
    /// From the left.
    pub columns: Range<u32>,
    /// From the top.
    pub rows: Range<u32>,
}

impl PixelRect {
    /// The pixels whose rays can meet the convex hull of world points; all of them if one is not in front of the eye.
    pub fn around(view: &View, world_points: impl IntoIterator<Item = DVec3>) -> Self {
        Self::of_positions(world_points.into_iter().map(|point| view.pixel_position(point)), view.size)
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        [&self.columns, &self.rows].map(|range| range.len() as u32)
    }

    /// Whether it has no pixels.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.rows.is_empty()
    }

    /// Its pixels that are not in another: above it, below it, to its left and to its right.
    pub fn without(&self, other: &Self) -> [Self; 4] {
        if other.is_empty() {
            let nothing = Self { columns: 0..0, rows: 0..0 };
            return [self.clone(), nothing.clone(), nothing.clone(), nothing];
        }
        let [left, right] = split(&self.columns, &other.columns);
        let [above, below] = split(&self.rows, &other.rows);
        let beside = above.end..below.start;
        let wide = |rows| Self { columns: self.columns.clone(), rows };
        let narrow = |columns| Self { columns, rows: beside.clone() };
        [wide(above), wide(below), narrow(left), narrow(right)]
    }

    /// Its pixels that are in another as well.
    pub fn within(&self, other: &Self) -> Self {
        let both = |a: &Range<u32>, b: &Range<u32>| a.start.max(b.start)..a.end.min(b.end);
        Self { columns: both(&self.columns, &other.columns), rows: both(&self.rows, &other.rows) }
    }

    /// The pixels of a picture of the second size that show anything of these of a picture of the first, when it is stretched to that
    /// size and interpolated.
    pub fn stretched(&self, from: [u32; 2], to: [u32; 2]) -> Self {
        let range = |range: &Range<u32>, axis: usize| {
            let scale = f64::from(to[axis]) / f64::from(from[axis]);
            let begin = (scale * (f64::from(range.start) - 0.5)).floor().max(0.0) as u32;
            let end = (scale * (f64::from(range.end) + 0.5)).ceil() as u32;
            if range.is_empty() { 0..0 } else { begin..end.min(to[axis]) }
        };
        Self { columns: range(&self.columns, 0), rows: range(&self.rows, 1) }
    }

    /// The pixels, of a picture of a size, about the convex hull of positions, in pixels from the top left; all of them if one
    /// is nowhere.
    pub(crate) fn of_positions(positions: impl Iterator<Item = Option<DVec2>>, size: [u32; 2]) -> Self {
        let [width, height] = size;
        let Some(pixels) = positions.collect::<Option<Vec<DVec2>>>() else {
            return Self { columns: 0..width, rows: 0..height };
        };
        let range = |along: fn(&DVec2) -> f64, size: u32| {
            let Range { start, end } = whole_pixels(pixels.iter().map(along));
            let within = |at: f64| at.clamp(0.0, f64::from(size)) as u32;
            within(start)..within(end)
        };
        Self { columns: range(|at| at.x, width), rows: range(|at| at.y, height) }
    }
}

/// What is before and what is after a part of a range, of which neither overlaps it.
fn split(all: &Range<u32>, part: &Range<u32>) -> [Range<u32>; 2] {
    let start = part.start.clamp(all.start, all.end);
    [all.start..start, part.end.clamp(start, all.end)..all.end]
}

/// The whole pixels that positions along an axis span, with the margin; some may be beyond the picture's edges.
pub(crate) fn whole_pixels(positions: impl Iterator<Item = f64>) -> Range<f64> {
    let (lowest, highest) =
        positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    (lowest - MARGIN).floor()..(highest + MARGIN).ceil()
}

impl View {
    /// Some of its pixels as a view of their own.
    #[must_use]
    pub fn part(&self, rect: &PixelRect) -> Self {
        let [width, height] = self.size.map(f64::from);
        let window = |[left, right, down, up]: [f64; 4]| {
            let across = |column: u32| left + (right - left) * f64::from(column) / width;
            let downwards = |row: u32| up + (down - up) * f64::from(row) / height;
            let PixelRect { columns, rows } = rect;
            [across(columns.start), across(columns.end), downwards(rows.end), downwards(rows.start)]
        };
        let projection = match self.projection {
            Projection::Perspective(f) => {
                let [left, right, down, up] = window([f.left, f.right, f.down, f.up]);
                Projection::Perspective(Frustum { left, right, down, up, ..f })
            }
            Projection::Orthographic(o) => {
                let [left_m, right_m, down_m, up_m] = window([o.left_m, o.right_m, o.down_m, o.up_m]);
                Projection::Orthographic(OrthographicBox { left_m, right_m, down_m, up_m, ..o })
            }
            Projection::Mcop(m) => {
                let [left_m, right_m, down_m, up_m] = window([m.left_m, m.right_m, m.down_m, m.up_m]);
                Projection::Mcop(Mcop { left_m, right_m, down_m, up_m, ..m })
            }
        };
        Self { projection, size: rect.size(), ..*self }
    }

    /// The nearest and the furthest depth of some points in world space, metres; negative behind the eye.
    pub fn depths_m(&self, points_world: &[DVec3]) -> (f64, f64) {
        points_world
            .iter()
            .map(|&at| -self.view_from_world.transform_point3(at).z)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), depth| (near.min(depth), far.max(depth)))
    }

    /// Where a world point is seen, in pixels from the top left; nowhere if it is not in front of the eye, or between the emitter's and
    /// the viewer's planes.
    pub fn pixel_position(&self, world: DVec3) -> Option<DVec2> {
        let at = self.view_from_world.transform_point3(world);
        let of_picture = match self.projection {
            Projection::Perspective(f) => {
                let depth_m = -at.z;
                if depth_m < f64::MIN_POSITIVE {
                    return None;
                }
                let (x, y) = (at.x / depth_m, at.y / depth_m);
                DVec2::new((x - f.left) / (f.right - f.left), (y - f.up) / (f.down - f.up))
            }
            Projection::Orthographic(o) => {
                DVec2::new((at.x - o.left_m) / (o.right_m - o.left_m), (at.y - o.up_m) / (o.down_m - o.up_m))
            }
            Projection::Mcop(m) => {
                let on_screen_m = m.screen_m(at)?;
                let (x, y) = (on_screen_m.x - m.left_m, on_screen_m.y - m.up_m);
                DVec2::new(x / (m.right_m - m.left_m), y / (m.down_m - m.up_m))
            }
        };
        Some(of_picture * DVec2::from(self.size.map(f64::from)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Orbit, RayField};
    use glam::DAffine3;
    use proptest::prelude::*;

    const SIZE: [u32; 2] = [90, 60];

    #[test]
    fn a_part_sees_what_the_view_sees_there() {
        let rect = PixelRect { columns: 20..70, rows: 7..31 };
        let frustum = Frustum { left: -0.7, right: 0.4, down: -0.3, up: 0.6, near_m: 0.1, far_m: 9.0 };
        let orthographic =
            OrthographicBox { left_m: -0.7, right_m: 0.4, down_m: -0.3, up_m: 0.6, near_m: 0.1, far_m: 9.0 };
        let mcop = Mcop {
            emitter_x_m: 0.1,
            emitter_z_m: -1.0,
            viewer_y_m: 0.2,
            viewer_z_m: 0.8,
            left_m: 0.5,
            right_m: -0.4,
            down_m: -0.3,
            up_m: 0.2,
            near_m: -0.7,
            far_m: 0.9,
        };
        let projections = [
            Projection::Perspective(frustum),
            Projection::Orthographic(orthographic),
            Projection::Mcop(mcop),
        ];
        for projection in projections {
            let view =
                View { view_from_world: DAffine3::IDENTITY, projection, size: SIZE, shaded_from: None };
            let part = view.part(&rect);
            assert_eq!(part.size, [50, 24]);
            let point = DVec3::new(0.03, -0.05, -0.4);
            let [at, in_part] = [view, part].map(|view| view.pixel_position(point).unwrap());
            assert!((at - DVec2::new(20.0, 7.0) - in_part).length() < 1e-9, "{at} {in_part}");
        }
    }

    fn cube(half: f64) -> impl Iterator<Item = DVec3> {
        (0..8).map(move |i| DVec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -half } else { half })))
    }

    fn views() -> [View; 2] {
        let frustum = Frustum::from_fov(0.9, SIZE).unwrap().sheared(0.2);
        let parallel = OrthographicBox::from_height(2.0, SIZE).unwrap();
        [Projection::Perspective(frustum), Projection::Orthographic(parallel)]
            .map(|projection| Orbit { azimuth_rad: 0.6, ..Default::default() }.view(projection, SIZE))
    }

    #[test]
    fn a_point_is_on_the_ray_of_its_pixel() {
        let point = DVec3::new(0.1, -0.2, 0.05);
        for view in views() {
            let at = view.pixel_position(point).unwrap();
            let (origin, direction) = RayField::new(&view, DAffine3::IDENTITY).at(at.x, at.y);
            let offset = (point - origin).cross(direction.normalize_or_zero());
            assert!(offset.length() < 1e-12, "{at} {offset}");
        }
    }

    #[test]
    fn every_ray_that_meets_a_cube_is_in_its_rectangle_and_few_others_are() {
        const HALF: f64 = 0.2;
        for view in views() {
            let rect = PixelRect::around(&view, cube(HALF));
            let rays = RayField::new(&view, DAffine3::IDENTITY);
            let mut hit = 0;
            for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
                let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let sides = [(-HALF - origin) / direction, (HALF - origin) / direction];
                let enter = sides[0].min(sides[1]).max_element();
                let leave = sides[0].max(sides[1]).min_element();
                if enter <= leave {
                    hit += 1;
                    assert!(rect.columns.contains(&x) && rect.rows.contains(&y), "{x} {y} {rect:?}");
                }
            }
            assert!(hit > 0 && rect.columns.len() * rect.rows.len() < 2 * hit, "{hit} {rect:?}");
        }
    }

    fn rects() -> impl Strategy<Value = PixelRect> {
        let range = || (0..9_u32, 0..7_u32).prop_map(|(start, length)| start..start + length);
        (range(), range()).prop_map(|(columns, rows)| PixelRect { columns, rows })
    }

    proptest! {
        #[test]
        fn what_is_left_of_a_rectangle_has_each_of_its_other_pixels_once(rect in rects(), other in rects()) {
            let left = rect.without(&other);
            for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
                let has = |of: &PixelRect| of.columns.contains(&x) && of.rows.contains(&y);
                let times = left.iter().filter(|part| has(part)).count();
                prop_assert_eq!(times, usize::from(has(&rect) && !has(&other)), "{} {}", x, y);
                prop_assert_eq!(has(&rect.within(&other)), has(&rect) && has(&other), "{} {}", x, y);
            }
        }
    }

    #[test]
    fn a_stretched_rectangle_has_the_pixels_that_interpolate_some_of_its_own() {
        let rect = PixelRect { columns: 3..5, rows: 0..2 };
        for (from, to) in [([9, 7], [9, 7]), ([9, 7], [18, 21]), ([9, 7], [5, 6]), ([9, 7], [10, 8])] {
            let stretched = rect.stretched(from, to);
            for (x, y) in (0..to[1]).flat_map(|y| (0..to[0]).map(move |x| (x, y))) {
                let meets = |at: u32, axis: usize, own: &Range<u32>| {
                    let middle = (f64::from(at) + 0.5) * f64::from(from[axis]) / f64::from(to[axis]);
                    own.clone().any(|pixel| (f64::from(pixel) + 0.5 - middle).abs() < 1.0)
                };
                if meets(x, 0, &rect.columns) && meets(y, 1, &rect.rows) {
                    assert!(
                        stretched.columns.contains(&x) && stretched.rows.contains(&y),
                        "{x} {y} {stretched:?}"
                    );
                }
            }
            assert!(stretched.columns.end <= to[0] && stretched.rows.end <= to[1]);
        }
        assert_eq!(rect.stretched([9, 7], [18, 21]), PixelRect { columns: 5..11, rows: 0..8 });
        let nothing = PixelRect { columns: 4..4, rows: 0..2 };
        assert!(nothing.stretched([9, 7], [18, 21]).is_empty());
    }

    #[test]
    fn a_body_around_the_eye_covers_everything_and_one_beside_the_picture_nothing() {
        for view in views() {
            let all = PixelRect { columns: 0..SIZE[0], rows: 0..SIZE[1] };
            assert_eq!(PixelRect::around(&view, cube(100.0)), all);
            let right = view.view_from_world.inverse().transform_vector3(DVec3::X);
            let beside = PixelRect::around(&view, cube(0.1).map(|point| point + 50.0 * right));
            assert!(beside.columns.is_empty(), "{beside:?}");
        }
    }
}
