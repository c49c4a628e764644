//! Something to stand on and to look to: comfort for those who lose their balance in empty space.

use glam::DVec3;
use std::f64::consts::TAU;

/// Side of the floor's squares, metres: half a step.
const SQUARE_M: f64 = 0.5;

/// How far the floor goes before it has faded away, squares.
const SQUARES: i32 = 8;

/// How far away the horizon is, metres: as good as infinitely far for eyes 63 mm apart.
const HORIZON_M: f64 = 200.0;

/// Lines that the horizon is made of.
const HORIZON_LINES: u32 = 96;

/// A straight line between two points in world space, metres, with its opacity at each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Where it begins and ends.
    pub ends_m: [DVec3; 2],
    /// Opacity at both ends, 0 to 1; even in between.
    pub alphas: [f32; 2],
}

/// A grid on the floor about somebody, which fades away within 4 m. Its lines stay where they are in the room when somebody
/// walks. `floor_y_m` is the floor's height: 0 where the reference space is a stage.
pub fn floor(eyes_m: DVec3, floor_y_m: f64) -> impl Iterator<Item = Line> {
    let [x, z] = [eyes_m.x, eyes_m.z].map(|middle_m| (middle_m / SQUARE_M).round());
    let corner = move |right: i32, back: i32| {
        DVec3::new((x + f64::from(right)) * SQUARE_M, floor_y_m, (z + f64::from(back)) * SQUARE_M)
    };
    let alpha = move |at: DVec3| {
        let distance_m = (at - eyes_m).with_y(0.0).length();
        (1.0 - distance_m / (f64::from(SQUARES) * SQUARE_M)).max(0.0) as f32
    };
    (-SQUARES..=SQUARES)
        .flat_map(|across| (-SQUARES..SQUARES).map(move |along| (across, along)))
        .flat_map(move |(across, along)| {
            let to_the_back = [corner(across, along), corner(across, along + 1)];
            let to_the_right = [corner(along, across), corner(along + 1, across)];
            [to_the_back, to_the_right].map(|ends_m| Line { ends_m, alphas: ends_m.map(alpha) })
        })
        .filter(|line| line.alphas != [0.0; 2])
}

/// A ring at the height of somebody's eyes, so far away that it does not come nearer.
pub fn horizon(eyes_m: DVec3) -> impl Iterator<Item = Line> {
    let at = move |line: u32| {
        let (sin, cos) = (TAU * f64::from(line % HORIZON_LINES) / f64::from(HORIZON_LINES)).sin_cos();
        eyes_m + HORIZON_M * DVec3::new(sin, 0.0, -cos)
    };
    (0..HORIZON_LINES).map(move |line| Line { ends_m: [at(line), at(line + 1)], alphas: [1.0; 2] })
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYES_M: DVec3 = DVec3::new(0.3, 1.7, -12.2);

    #[test]
    fn the_floor_fades_and_stays_in_place() {
        let lines: Vec<Line> = floor(EYES_M, 0.1).collect();
        let walked: Vec<Line> = floor(EYES_M + DVec3::new(0.6, 0.3, 0.0), 0.1).collect();
        let place =
            |line: &Line| line.ends_m.map(|end| (end / SQUARE_M).round().to_array().map(|c| c as i64));
        let shared =
            lines.iter().filter(|line| walked.iter().any(|other| place(other) == place(line))).count();
        assert!(shared > lines.len() / 2 && shared < lines.len(), "{shared} of {}", lines.len());
        for line in &lines {
            for (end, alpha) in line.ends_m.into_iter().zip(line.alphas) {
                assert_eq!(end.y, 0.1);
                let squares = [end.x, end.z].map(|coordinate| coordinate / SQUARE_M);
                assert!(squares.iter().all(|square| (square - square.round()).abs() < 1e-12));
                let expected = 1.0 - (end - EYES_M).with_y(0.0).length() / 4.0;
                assert!((f64::from(alpha) - expected.max(0.0)).abs() < 1e-6);
            }
        }
        assert!(lines.iter().any(|line| line.alphas[0] > 0.9));
        assert!(lines.iter().any(|line| line.alphas.contains(&0.0)));
    }

    #[test]
    fn the_horizon_is_closed_and_level() {
        let lines: Vec<Line> = horizon(EYES_M).collect();
        for (line, next) in lines.iter().zip(lines.iter().cycle().skip(1)) {
            assert_eq!(line.ends_m[1], next.ends_m[0]);
            assert_eq!(line.ends_m[0].y, EYES_M.y);
            assert!(((line.ends_m[0] - EYES_M).length() - HORIZON_M).abs() < 1e-9);
        }
    }
}
