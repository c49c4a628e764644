//! Which views are cast, and how the others come of them.

use super::{AnchorError, DepthSlabs};
use crate::scene::Mode;
use crate::stereo::Epipolar;
use crate::view::{Projection, View, whole_pixels};
use glam::DVec3;

/// Most slabs: an anchor of 420 × 560 pixels then takes 45 MB. With more of them, another anchor costs less than what they take to pass.
pub const MOST_SLABS: u32 = 48;

/// How far the places move against each other, in the view furthest from its anchor, that are in one slab, pixels: what is at its bounds
/// is half of that off there.
pub const THICKNESS_PX: f64 = 2.0;

/// Least anchors that are chosen without being asked for: what hides things from one is passed by the other.
const LEAST_ANCHORS: u32 = 2;

/// Views for each anchor from which on casting a few pays: an anchor takes up to twice as long as a cast by itself.
pub const LEAST_VIEWS_PER_ANCHOR: u32 = 3;

/// A view that is cast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anchor {
    /// The view, with as many columns more on either side as views derived of it see, and shaded from the middle one of these.
    pub view: View,
    /// Which view it is.
    pub index: usize,
    /// Columns that it has more on the left.
    pub left_px: u32,
}

/// How a picture comes of an anchor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// Which anchor.
    pub anchor: usize,
    /// From a column of the picture to that of the anchor's at which it sees the nearest slab.
    pub offset_px: f64,
    /// How many columns further to the right each next slab is seen.
    pub per_slab_px: f64,
}

/// A view, and the anchor that it comes of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derived {
    /// The view.
    pub view: View,
    /// The nearest anchor.
    pub source: Source,
}

/// Anchors for some views.
#[derive(Debug, Clone, PartialEq)]
pub struct AnchorPlan {
    /// What is cast, from the first view to the last.
    pub anchors: Vec<Anchor>,
    /// Every view, in order.
    pub derived: Vec<Derived>,
    /// What rays of anchors are cut into.
    pub slabs: DepthSlabs,
}

impl AnchorPlan {
    /// How the picture of an anchor comes of those next to it, which see some of what it does not.
    ///
    /// # Panics
    /// If there is no such anchor.
    pub fn neighbours(&self, anchor: usize) -> Vec<Source> {
        let own = &self.anchors[anchor];
        let next_to = [anchor.checked_sub(1), Some(anchor + 1).filter(|&next| next < self.anchors.len())];
        let sources = next_to.into_iter().flatten().filter_map(|next| {
            let cast = &self.anchors[next];
            let epipolar =
                Epipolar::new(&self.derived[cast.index].view, &self.derived[own.index].view).ok()?;
            let source = source(&epipolar, next, cast, &self.slabs);
            Some(Source { offset_px: source.offset_px - f64::from(own.left_px), ..source })
        });
        sources.collect()
    }

    /// As few anchors as their slabs allow, but at least two: [`MOST_SLABS`] of them, in each of which nothing moves by more than [`THICKNESS_PX`], cover
    /// the depths of a convex body with corners in world space.
    ///
    /// Anchors are spread evenly from the first view to the last, so that what one does not see is seen from the other side; a single one is
    /// in the middle.
    ///
    /// # Errors
    /// What keeps views from being derived from each other; no number of anchors that pays.
    pub fn new(views: &[View], mode: Mode, corners_world: &[DVec3]) -> Result<Self, AnchorError> {
        let most = views.len() as u32 / LEAST_VIEWS_PER_ANCHOR;
        for count in LEAST_ANCHORS..=most {
            match Groups::new(views, mode, corners_world, count) {
                Ok(groups) if groups.needed_slabs() <= f64::from(MOST_SLABS) => {
                    return groups.plan();
                }
                Ok(_) => {}
                Err(AnchorError::TooNear { .. }) if count < most => {}
                Err(error) => return Err(error),
            }
        }
        Err(AnchorError::DoesNotPay { views: views.len(), most })
    }

    /// So many anchors; where their slabs would have to be more than [`MOST_SLABS`], they are thicker.
    ///
    /// # Errors
    /// What keeps views from being derived from each other; more anchors than views, or none.
    pub fn with_count(
        views: &[View],
        mode: Mode,
        corners_world: &[DVec3],
        count: u32,
    ) -> Result<Self, AnchorError> {
        if count == 0 || count as usize > views.len() {
            return Err(AnchorError::Count { count, views: views.len() });
        }
        Groups::new(views, mode, corners_world, count)?.plan()
    }
}

/// Which of so many views are anchors.
fn indices(views: usize, anchors: usize) -> Vec<usize> {
    if anchors == 1 {
        return vec![(views - 1) / 2];
    }
    let last = (views - 1) as f64;
    (0..anchors).map(|anchor| (anchor as f64 * last / (anchors - 1) as f64).round() as usize).collect()
}

/// Which of some anchors is nearest to a view; itself, if there are none.
fn nearest(indices: &[usize], view: usize) -> usize {
    indices.iter().copied().min_by_key(|anchor| anchor.abs_diff(view)).unwrap_or(view)
}

/// Views, and which of them are anchors.
struct Groups<'a> {
    views: &'a [View],
    corners_world: &'a [DVec3],
    /// Which views are anchors.
    indices: Vec<usize>,
    /// 1/depth of the nearest and the furthest of what is seen, 1/m.
    per_m: [f64; 2],
    /// The largest disparity times depth between a view and its anchor, pixels · metres.
    largest_k: f64,
}

impl<'a> Groups<'a> {
    fn new(
        views: &'a [View],
        mode: Mode,
        corners_world: &'a [DVec3],
        count: u32,
    ) -> Result<Self, AnchorError> {
        let first = views.first().ok_or(AnchorError::NoViews)?;
        if mode != Mode::Composite {
            return Err(AnchorError::Mode(mode));
        }
        let indices = indices(views.len(), count as usize);
        let (mut largest_k, mut least_m) = (0.0_f64, 0.0_f64);
        for (index, view) in views.iter().enumerate() {
            let epipolar = Epipolar::new(&views[nearest(&indices, index)], view)?;
            largest_k = largest_k.max(epipolar.k());
            least_m = least_m.max(epipolar.least_depth_m());
        }
        // Views that are no anchor's neighbours must be side by side, too.
        Epipolar::new(first, &views[views.len() - 1])?;
        let depths_m = Epipolar::new(first, first)?.depths_m(corners_world).unwrap_or(1.0..2.0);
        if depths_m.start < least_m {
            return Err(AnchorError::TooNear { nearest_m: depths_m.start, least_m, count });
        }
        let per_m = [depths_m.start.recip(), depths_m.end.recip()];
        Ok(Self { views, corners_world, indices, per_m, largest_k })
    }

    /// Slabs in each of which nothing moves by more than [`THICKNESS_PX`].
    fn needed_slabs(&self) -> f64 {
        let [nearest, furthest] = self.per_m;
        (self.largest_k * (nearest - furthest) / THICKNESS_PX).ceil().max(1.0)
    }

    fn plan(&self) -> Result<AnchorPlan, AnchorError> {
        let [nearest_per_m, furthest_per_m] = self.per_m;
        let count = self.needed_slabs().min(f64::from(MOST_SLABS)) as u32;
        let thickness_per_m = ((nearest_per_m - furthest_per_m) / f64::from(count)).max(f64::MIN_POSITIVE);
        let slabs = DepthSlabs { nearest_per_m, thickness_per_m, count };
        let anchors = self.indices.iter().map(|&index| self.anchor(index)).collect::<Result<Vec<_>, _>>()?;
        let derived =
            self.views.iter().map(|view| self.derived(view, &anchors, &slabs)).collect::<Result<_, _>>()?;
        Ok(AnchorPlan { anchors, derived, slabs })
    }

    /// The view in the middle of those that an anchor is nearest to.
    fn middle(&self, index: usize) -> &View {
        let mut served = (0..self.views.len()).filter(|&view| nearest(&self.indices, view) == index);
        let first = served.next().unwrap_or(index);
        &self.views[(first + served.next_back().unwrap_or(first)) / 2]
    }

    /// An anchor with the columns beyond its edges in which the body is seen, at most as many as it has.
    fn anchor(&self, index: usize) -> Result<Anchor, AnchorError> {
        let view = View { shaded_from: Some(self.middle(index).viewpoint()), ..self.views[index] };
        let Projection::Perspective(frustum) = view.projection else {
            unreachable!("pairs of other views are refused")
        };
        let [width, height] = view.size;
        let corners = self.corners_world.iter().map(|&corner| view.pixel_position(corner));
        let beyond = match corners.collect::<Option<Vec<_>>>() {
            None => 0.0..f64::from(width),
            Some(corners) => whole_pixels(corners.iter().map(|at| at.x)),
        };
        let most = f64::from(width);
        let left_px = (-beyond.start).clamp(0.0, most);
        let right_px = (beyond.end - f64::from(width)).clamp(0.0, most);
        let per_px = (frustum.right - frustum.left) / f64::from(width);
        let frustum = crate::view::Frustum {
            left: frustum.left - left_px * per_px,
            right: frustum.right + right_px * per_px,
            ..frustum
        };
        let left_px = left_px as u32;
        let size = [width + left_px + right_px as u32, height];
        let view = View { projection: Projection::Perspective(frustum), size, ..view };
        Ok(Anchor { view, index, left_px })
    }

    fn derived(&self, view: &View, anchors: &[Anchor], slabs: &DepthSlabs) -> Result<Derived, AnchorError> {
        let sources = (0..anchors.len())
            .map(|anchor| {
                let epipolar = Epipolar::new(&self.views[anchors[anchor].index], view)?;
                Ok((epipolar.k(), source(&epipolar, anchor, &anchors[anchor], slabs)))
            })
            .collect::<Result<Vec<_>, AnchorError>>()?;
        let nearest = sources.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b));
        let (_, source) = nearest.ok_or(AnchorError::NoViews)?;
        Ok(Derived { view: *view, source })
    }
}

/// How a view comes of an anchor.
fn source(epipolar: &Epipolar, anchor: usize, cast: &Anchor, slabs: &DepthSlabs) -> Source {
    let moved_px = |slab| -epipolar.derived_position(0.0, slabs.middle_per_m(slab).recip());
    let (first, second) = (moved_px(0), moved_px(1));
    Source { anchor, offset_px: first + f64::from(cast.left_px), per_slab_px: second - first }
}
