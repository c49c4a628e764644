//! How the rays of a view pass through the picture of another.

use super::{FirstHits, TILE};
use crate::cast::CastParameters;
use crate::view::{Projection, RayField, View};
use glam::{DAffine3, DVec3, DVec4};

/// Slabs that the depths of a view are cut into: tiles are looked up for each.
pub const SLABS: usize = 8;

/// Most tiles along an axis that are looked up for a slab; where it covers more nothing is leapt over.
pub const MOST_TILES: u32 = 6;

/// How far beside what was seen something may be, pixels of the picture that it was seen in.
pub const MARGIN_PX: f64 = 1.0;

/// How far beyond the picture's edge its outermost rays tell what is there, pixels.
const EDGE_PX: f64 = 0.5;

/// From pixel and depth of a view to the picture of the last one.
///
/// The point at pixel position (x, y), in pixels from the top left, and at depth z has the homogeneous coordinates `o + z · d` with
/// `o = origin[0] + x · origin[1] + y · origin[2]` and d alike: (column · w, row · w, w, depth), depth in metres along the last
/// view's −Z. All are affine in depth, so that what they are at the corners of a part of a tile's frustum bounds them within it.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Coordinates at depth 0: at the top left, and their change per pixel to the right and down.
    pub origin: [DVec4; 3],
    /// Change of the coordinates per metre of depth, alike.
    pub direction: [DVec4; 3],
    /// Bounds of the slabs from near to far, metres: equally far apart in the last picture if it was seen from beside.
    pub slab_depths_m: [f64; SLABS + 1],
    /// Nearest and furthest depth that the last picture shows, metres.
    pub last_range_m: (f64, f64),
    /// How much nearer something may be than what was seen, metres.
    pub margin_m: f64,
    /// Width and height of the last picture, pixels.
    pub last_size: [u32; 2],
}

impl Passage {
    /// From a view of a scene to the picture of the last one; nothing if their numbers are not finite.
    pub fn between(view: &View, last: &View, margin_m: f64, parameters: &CastParameters) -> Option<Self> {
        let rays = RayField::new(view, DAffine3::IDENTITY);
        let point = |at: DVec3| homogeneous(last, last.view_from_world.transform_point3(at), 1.0);
        let vector = |along: DVec3| homogeneous(last, last.view_from_world.transform_vector3(along), 0.0);
        let (near_m, far_m) = view.projection.depth_range_m();
        let (nearest_m, furthest_m) = view.depths_m(&parameters.visible_corners_world());
        let start_m = nearest_m.max(near_m);
        let end_m = furthest_m.min(far_m).max(start_m);
        let slab_depths_m = std::array::from_fn(|i| {
            let share = i as f64 / SLABS as f64;
            match view.projection {
                Projection::Perspective(_) => 1.0 / ((1.0 - share) / start_m + share / end_m),
                Projection::Orthographic(_) | Projection::Mcop(_) => (1.0 - share) * start_m + share * end_m,
            }
        });
        let passage = Self {
            origin: [point(rays.origin), vector(rays.origin_dx), vector(rays.origin_dy)],
            direction: [rays.direction, rays.direction_dx, rays.direction_dy].map(vector),
            slab_depths_m,
            last_range_m: last.projection.depth_range_m(),
            margin_m,
            last_size: last.size,
        };
        let vectors = passage.origin.iter().chain(&passage.direction);
        let is_sound = vectors.into_iter().all(|v| v.is_finite())
            && passage.slab_depths_m.iter().all(|depth_m| depth_m.is_finite())
            && margin_m.is_finite();
        is_sound.then_some(passage)
    }

    /// The depth before which no ray of a tile of the view meets what may not be empty, metres; infinite if none does at all.
    pub(super) fn start_m(&self, view: &View, hits: &FirstHits, tile: [u32; 2]) -> f64 {
        let [left, top] = tile.map(|index| index * TILE);
        let [right, bottom] = [(left + TILE).min(view.size[0]), (top + TILE).min(view.size[1])];
        let corners = [[left, top], [right, top], [left, bottom], [right, bottom]].map(|corner| {
            let [x, y] = corner.map(f64::from);
            let at = |[first, dx, dy]: [DVec4; 3]| first + x * dx + y * dy;
            (at(self.origin), at(self.direction))
        });
        for slab in self.slab_depths_m.windows(2) {
            let Some(nearest_m) = self.nearest_m(hits, &corners, [slab[0], slab[1]]) else { return slab[0] };
            let limit_m = (nearest_m - self.margin_m).min(self.last_range_m.1);
            let meets_m = corners.map(|(origin, direction)| {
                if origin.w + slab[0] * direction.w > limit_m {
                    slab[0]
                } else if direction.w > 0.0 {
                    (limit_m - origin.w) / direction.w
                } else {
                    f64::INFINITY
                }
            });
            let start_m = meets_m.into_iter().fold(f64::INFINITY, f64::min);
            if start_m < slab[1] {
                return start_m;
            }
        }
        f64::INFINITY
    }

    /// The nearest that was seen where a part of a tile's frustum is in the last picture, metres; nothing if it is not all in there, or in
    /// too much of it.
    fn nearest_m(&self, hits: &FirstHits, corners: &[(DVec4, DVec4); 4], depths_m: [f64; 2]) -> Option<f64> {
        let ends = corners.iter().flat_map(|(origin, direction)| depths_m.map(|z| origin + z * direction));
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for end in ends {
            let is_in_front = end.z > 0.0 && end.w >= self.last_range_m.0;
            if !is_in_front {
                return None;
            }
            for (axis, along) in [end.x / end.z, end.y / end.z].into_iter().enumerate() {
                low[axis] = low[axis].min(along);
                high[axis] = high[axis].max(along);
            }
        }
        let tiles = [0, 1].map(|axis| {
            let size = f64::from(self.last_size[axis]);
            let is_within = low[axis] >= -EDGE_PX && high[axis] <= size + EDGE_PX;
            let tile = |at: f64| at.clamp(0.0, size - 1.0) as u32 / TILE;
            let (first, last) = (tile(low[axis] - MARGIN_PX), tile(high[axis] + MARGIN_PX));
            (is_within && last - first < MOST_TILES).then_some(first..=last)
        });
        let [Some(columns), Some(rows)] = tiles else { return None };
        let depths_m = rows.flat_map(|row| columns.clone().map(move |column| hits.of_tile(column, row)));
        Some(depths_m.fold(f64::INFINITY, f64::min))
    }
}

/// A point (`w` = 1) or vector (0) in a view's space in the homogeneous coordinates of its picture; not a number for pictures of
/// projectors, which have none.
fn homogeneous(view: &View, at: DVec3, w: f64) -> DVec4 {
    let [width, height] = view.size.map(f64::from);
    match view.projection {
        Projection::Perspective(f) => {
            let (across, down) = (width / (f.right - f.left), height / (f.down - f.up));
            DVec4::new((at.x + f.left * at.z) * across, (at.y + f.up * at.z) * down, -at.z, -at.z)
        }
        Projection::Orthographic(o) => {
            let (across, down) = (width / (o.right_m - o.left_m), height / (o.down_m - o.up_m));
            DVec4::new((at.x - w * o.left_m) * across, (at.y - w * o.up_m) * down, w, -at.z)
        }
        Projection::Mcop(_) => DVec4::NAN,
    }
}
