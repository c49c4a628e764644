//! Pictures of eyes that rest, drawn a few rows per refresh and shown when they are whole.

use super::way::{Means, Way};
use std::collections::VecDeque;
use std::ops::Range;
use wheatstone_core::view::View;
use wheatstone_render::warp::Canvas;

/// Pictures that are being drawn.
pub(super) struct Finer {
    pub(super) pictures: Vec<Canvas>,
    left: VecDeque<Part>,
}

/// Some rows of an eye's picture.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    pub(super) eye: usize,
    pub(super) rows: Range<u32>,
    /// What it takes, steps of the search for surfaces.
    steps: f64,
}

impl Finer {
    /// Nothing is drawn of the pictures yet, whose parts are these.
    pub(super) fn new(pictures: Vec<Canvas>, parts: impl IntoIterator<Item = Part>) -> Self {
        Self { pictures, left: parts.into_iter().collect() }
    }

    /// As many parts as there is time for, but at least one, as long as some are left.
    pub(super) fn take(&mut self, most_steps: f64) -> Vec<Part> {
        let mut taken = Vec::new();
        let mut steps = 0.0;
        while let Some(part) =
            self.left.pop_front_if(|part| taken.is_empty() || steps + part.steps <= most_steps)
        {
            steps += part.steps;
            taken.push(part);
        }
        taken
    }

    pub(super) fn is_whole(&self) -> bool {
        self.left.is_empty()
    }
}

/// The parts of an eye's picture, of which none takes longer than a refresh, unless a row does: each row is in one of them.
pub(super) fn parts(
    means: &Means,
    (eye, way): (usize, Way),
    shown: &View,
    wanted: &View,
    most_steps: f64,
) -> Vec<Part> {
    let (covered, height) = (means.covered(wanted), wanted.size[1]);
    let of_row = means.steps_of_row(shown, wanted, way, &covered);
    let rows_each = ((most_steps / of_row.max(1.0)) as u32).max(1);
    let mut parts: Vec<Part> = Vec::new();
    let mut start = 0;
    while start < height {
        let first = start.max(covered.rows.start.min(height - 1));
        let end = first.saturating_add(rows_each);
        let end = if end >= covered.rows.end { height } else { end };
        parts.push(Part {
            eye,
            rows: start..end,
            steps: f64::from(end.min(covered.rows.end).saturating_sub(first)) * of_row,
        });
        start = end;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::super::super::state::{Edit, State};
    use super::super::BeyondReach;
    use super::*;
    use glam::DVec3;
    use wheatstone_core::budget::Quality;
    use wheatstone_core::warp::VolumetricSettings;

    fn means() -> Means {
        Means {
            quality: Quality::FULL,
            corners: std::array::from_fn(|corner| {
                DVec3::from([1, 2, 4].map(|axis| if corner & axis == 0 { -0.2 } else { 0.2 }))
            }),
            keeps_layers: true,
            stepping: VolumetricSettings::default(),
            most_steps: f64::INFINITY,
            beyond_reach: BeyondReach::AsItIs,
        }
    }

    #[test]
    fn every_row_is_drawn_once_and_no_part_takes_too_long() {
        let mut state = State::default();
        let shown = state.camera.view([480, 260]).unwrap();
        state.apply(&Edit::Orbit { right_deg: 5.0, up_deg: 0.0 }).unwrap();
        let wanted = state.camera.view([480, 260]).unwrap();
        let way = Way::Grid(Quality::FULL);
        let whole = parts(&means(), (1, way), &shown, &wanted, f64::INFINITY);
        assert_eq!(whole.len(), 1);
        let all_steps = whole[0].steps;
        for share in [0.5, 0.11, 0.01, 1e-9] {
            let parts = parts(&means(), (1, way), &shown, &wanted, share * all_steps);
            let rows: Vec<u32> = parts.iter().flat_map(|part| part.rows.clone()).collect();
            assert!(rows.iter().copied().eq(0..260), "{parts:?}");
            let of_row = all_steps / means().covered(&wanted).rows.len() as f64;
            assert!(
                parts
                    .iter()
                    .all(|part| part.eye == 1 && part.steps <= (share * all_steps).max(of_row) + 1e-6)
            );
            let sum: f64 = parts.iter().map(|part| part.steps).sum();
            assert!((sum / all_steps - 1.0).abs() < 1e-9, "{sum} of {all_steps}");
            let rows = means().covered(&wanted).rows.len() as f64;
            assert!(parts.len() as f64 >= (1.0 / share).min(rows).floor(), "{}", parts.len());
        }
    }

    #[test]
    fn a_refresh_takes_what_fits_and_at_least_one_part() {
        let part = |rows: Range<u32>, steps| Part { eye: 0, rows, steps };
        let all = [part(0..1, 5.0), part(1..2, 1.0), part(2..3, 1.0), part(3..4, 1.0)];
        let mut finer = Finer::new(Vec::new(), all.clone());
        assert_eq!(finer.take(2.0), all[..1]);
        assert_eq!(finer.take(2.0), all[1..3]);
        assert!(!finer.is_whole());
        assert_eq!(finer.take(2.0), all[3..]);
        assert!(finer.is_whole() && finer.take(2.0).is_empty());
    }
}
