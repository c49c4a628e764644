//! How much of what is wanted a picture shows.

use crate::view::View;
use glam::DVec3;

/// Cells of a body along each axis, for the middles of which it is asked who sees them.
const CELLS: u32 = 6;

/// How much of what one view sees of a body another view's picture shows, and how obliquely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Mean angle at the body between the directions to both eyes, radians.
    pub turn_rad: f64,
    /// The part, 0 to 1, that is in the shown picture, too.
    pub share: f64,
}

impl Overlap {
    /// That of a box with corners in world space, metres: those along its first axis next to each other, then those along its
    /// second one. Of a box of which the wanted view sees nothing, everything is shown.
    pub fn of(shown: &View, wanted: &View, corners_world: &[DVec3; 8]) -> Self {
        let eyes_m = [shown, wanted].map(|view| view.view_from_world.inverse().translation);
        let (mut seen, mut seen_by_both, mut turns_rad) = (0_u32, 0_u32, 0.0);
        for middle in cell_middles(corners_world).filter(|&middle| is_in_picture(wanted, middle)) {
            let [from_shown, from_wanted] = eyes_m.map(|eye_m| eye_m - middle);
            seen += 1;
            seen_by_both += u32::from(is_in_picture(shown, middle));
            turns_rad += from_shown.angle_between(from_wanted);
        }
        if seen == 0 {
            return Self { turn_rad: 0.0, share: 1.0 };
        }
        Self { turn_rad: turns_rad / f64::from(seen), share: f64::from(seen_by_both) / f64::from(seen) }
    }
}

fn cell_middles(&[origin, along_x, along_y, _, along_z, ..]: &[DVec3; 8]) -> impl Iterator<Item = DVec3> {
    let along = move |cell: u32| (f64::from(cell) + 0.5) / f64::from(CELLS);
    (0..CELLS.pow(3)).map(move |cell| {
        let [x, y, z] = [cell % CELLS, cell / CELLS % CELLS, cell / CELLS.pow(2)].map(along);
        origin + x * (along_x - origin) + y * (along_y - origin) + z * (along_z - origin)
    })
}

fn is_in_picture(view: &View, world: DVec3) -> bool {
    let [width, height] = view.size.map(f64::from);
    let position = view.pixel_position(world);
    position.is_some_and(|at| (0.0..width).contains(&at.x) && (0.0..height).contains(&at.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Frustum, Orbit, Projection};
    use glam::DAffine3;

    const SIZE: [u32; 2] = [90, 60];

    fn corners() -> [DVec3; 8] {
        std::array::from_fn(|i| {
            DVec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -0.5 } else { 0.5 }))
        })
    }

    fn orbit(azimuth_deg: f64, distance_m: f64) -> View {
        let frustum = Frustum::from_fov(0.7, SIZE).unwrap();
        let orbit = Orbit { azimuth_rad: azimuth_deg.to_radians(), elevation_rad: 0.0, distance_m };
        orbit.view(Projection::Perspective(frustum), SIZE)
    }

    /// Turned in place.
    fn turned(view: View, right_deg: f64) -> View {
        let turn = DAffine3::from_rotation_y(right_deg.to_radians());
        View { view_from_world: turn * view.view_from_world, ..view }
    }

    #[test]
    fn an_orbit_turns_by_its_angle_and_keeps_everything_in_the_picture() {
        for turn_deg in [0.0, 10.0, 60.0, 90.0, 180.0] {
            let overlap = Overlap::of(&orbit(20.0, 4.0), &orbit(20.0 + turn_deg, 4.0), &corners());
            // Halfway round, what is beside the axis turns by less.
            assert!(
                (0.94..1.06).contains(&(overlap.turn_rad.to_degrees().max(1.0) / turn_deg.max(1.0))),
                "{turn_deg}: {overlap:?}"
            );
            assert_eq!(overlap.share, 1.0);
        }
    }

    #[test]
    fn a_turn_of_the_head_shows_less_the_further_it_goes_but_from_the_same_side() {
        let shares = [0.0, 15.0, 30.0, 60.0].map(|right_deg| {
            let overlap = Overlap::of(&turned(orbit(0.0, 2.0), right_deg), &orbit(0.0, 2.0), &corners());
            assert_eq!(overlap.turn_rad, 0.0);
            overlap.share
        });
        assert!(shares[0] == 1.0 && shares[0] > shares[1] && shares[1] > shares[2], "{shares:?}");
        assert_eq!(shares[3], 0.0);
    }

    #[test]
    fn a_step_within_the_body_is_a_small_turn_and_looking_back_shows_nothing() {
        let before = orbit(0.0, 0.02);
        let step = Overlap::of(&before, &orbit(0.0, -0.02), &corners());
        assert!(step.turn_rad < 0.3 && step.share > 0.8, "{step:?}");
        assert_eq!(Overlap::of(&before, &turned(before, 180.0), &corners()).share, 0.0);
    }

    #[test]
    fn where_nothing_is_wanted_nothing_is_missing() {
        let away = turned(orbit(0.0, 2.0), 180.0);
        assert_eq!(Overlap::of(&orbit(0.0, 2.0), &away, &corners()), Overlap { turn_rad: 0.0, share: 1.0 });
    }
}
