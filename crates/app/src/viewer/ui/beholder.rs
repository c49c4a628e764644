//! Whose eyes the picture is for: the camera's, or a headset's.

use crate::viewer::state::{Arrangement, State};
use egui::{Rect, Vec2};
use wheatstone_core::view::{Projection, View};

/// Whose eyes the picture is for.
#[derive(Debug)]
pub(crate) enum Beholder {
    /// The camera's, which panels, mouse and keys move.
    Camera,
    /// A headset's, which nothing here moves.
    Headset {
        /// What the left and the right eye see, in world space; none as long as they see nothing.
        views: Option<Box<[View; 2]>>,
    },
}

impl Beholder {
    /// The part of the window's middle that the picture takes: all of it, or for a headset the largest rectangle in which it is not
    /// distorted.
    pub(super) fn area(&self, middle: Rect, arrangement: Arrangement) -> Rect {
        let Self::Headset { views: Some(views) } = self else { return middle };
        let Projection::Perspective(lens) = views[0].projection else { return middle };
        let width_over_height =
            beside_each_other(arrangement) * ((lens.right - lens.left) / (lens.up - lens.down)) as f32;
        let height = middle.height().min(middle.width() / width_over_height);
        Rect::from_center_size(middle.center(), Vec2::new(width_over_height * height, height))
    }

    /// What is seen where in the picture's area: by each eye side by side, or by one. For the camera that is the middle between
    /// the eyes, for a headset the left one. Nothing of a light-field display's many views.
    pub(super) fn seen(&self, state: &State, area: Rect) -> Vec<(View, Rect)> {
        if matches!(self, Self::Camera) && state.stereo.arrangement.is_of_display() {
            return Vec::new();
        }
        let is_side_by_side = state.stereo.arrangement == Arrangement::SideBySide;
        let views = match self {
            Self::Camera => {
                let size = [area.width().max(1.0) as u32, area.height().max(1.0) as u32];
                let Ok(middle) = state.camera.view(state.stereo.eye_size(size)) else { return Vec::new() };
                if is_side_by_side {
                    state.stereo.views(&middle, state.camera.distance_m)
                } else {
                    vec![middle]
                }
            }
            Self::Headset { views } => views.iter().flat_map(|views| views.iter()).copied().collect(),
        };
        if is_side_by_side {
            let (left, right) = area.split_left_right_at_fraction(0.5);
            views.into_iter().zip([left, right]).collect()
        } else {
            views.into_iter().zip([area]).collect()
        }
    }
}

/// The shorter side of an eye's picture within the picture's area, points: what drags are measured by.
pub(super) fn shorter_side(area: Rect, arrangement: Arrangement) -> f32 {
    area.height().min(area.width() / beside_each_other(arrangement))
}

/// Pictures of eyes from left to right.
fn beside_each_other(arrangement: Arrangement) -> f32 {
    if arrangement == Arrangement::SideBySide { 2.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Pos2, vec2};
    use glam::DAffine3;
    use wheatstone_core::view::Frustum;

    #[test]
    fn a_headsets_picture_is_as_wide_for_its_height_as_its_eyes_see() {
        let lens = Frustum { left: -1.0, right: 0.8, down: -1.1, up: 0.9, near_m: 0.1, far_m: f64::INFINITY };
        let view = View {
            view_from_world: DAffine3::IDENTITY,
            projection: Projection::Perspective(lens),
            size: [640, 720],
            shaded_from: None,
        };
        let headset = Beholder::Headset { views: Some(Box::new([view; 2])) };
        let middle = Rect::from_min_size(Pos2::new(10.0, 20.0), vec2(650.0, 400.0));
        let mut state = State::default();
        let one = headset.area(middle, Arrangement::Mono);
        assert!((one.size() - vec2(360.0, 400.0)).length() < 1e-3 && one.center() == middle.center());
        assert_eq!(headset.seen(&state, one), [(view, one)]);
        state.stereo.arrangement = Arrangement::SideBySide;
        let both = headset.area(middle, state.stereo.arrangement);
        assert!((both.size() - vec2(650.0, 325.0 / 0.9)).length() < 1e-3, "{both}");
        let halves: Vec<Rect> = headset.seen(&state, both).into_iter().map(|(_, half)| half).collect();
        assert_eq!((halves[0].left(), halves[1].right()), (both.left(), both.right()));
        assert_eq!(halves[0].right(), halves[1].left());
    }
}
