//! A cube whose faces are lettered with the patient directions they face.

use glam::DVec3;

/// Value of the cube's body.
pub const CUBE_VALUE: f64 = 0.35;
/// Value of the raised letters.
pub const LETTER_VALUE: f64 = 1.0;

const HALF_SIZE: f64 = 0.36;
const RELIEF: f64 = 0.06;
/// Side of one dot of a letter.
const DOT: f64 = 0.08;

/// Rows from the top, five dots each from the left: bit 4 is the leftmost.
type Glyph = [u8; 7];
const R: Glyph = [0b11110, 0b10001, 0b10001, 0b11110, 0b10100, 0b10010, 0b10001];
const L: Glyph = [0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b11111];
const A: Glyph = [0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001];
const P: Glyph = [0b11110, 0b10001, 0b10001, 0b11110, 0b10000, 0b10000, 0b10000];
const S: Glyph = [0b01111, 0b10000, 0b10000, 0b01110, 0b00001, 0b00001, 0b11110];
const I: Glyph = [0b01110, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110];

struct Face {
    letter: Glyph,
    outward: DVec3,
    up: DVec3,
}

const FACES: [Face; 6] = [
    Face { letter: R, outward: DVec3::X, up: DVec3::Z },
    Face { letter: L, outward: DVec3::NEG_X, up: DVec3::Z },
    Face { letter: A, outward: DVec3::Y, up: DVec3::Z },
    Face { letter: P, outward: DVec3::NEG_Y, up: DVec3::Z },
    Face { letter: S, outward: DVec3::Z, up: DVec3::Y },
    Face { letter: I, outward: DVec3::NEG_Z, up: DVec3::Y },
];

pub(super) fn value(point: DVec3) -> f64 {
    let p = point - 0.5;
    if p.abs().max_element() <= HALF_SIZE {
        return CUBE_VALUE;
    }
    let on_letter = FACES.iter().any(|face| {
        let height = p.dot(face.outward) - HALF_SIZE;
        // The viewer looks along −outward, so the right hand is up × outward.
        let (right, up) = (p.dot(face.up.cross(face.outward)), p.dot(face.up));
        height > 0.0 && height <= RELIEF && has_dot(&face.letter, right, up)
    });
    if on_letter { LETTER_VALUE } else { 0.0 }
}

/// Whether a centred glyph has a dot at a distance to the right and upwards of its centre.
fn has_dot(glyph: &Glyph, right: f64, up: f64) -> bool {
    let (column, row) = ((right / DOT + 2.5).floor(), (3.5 - up / DOT).floor());
    (0.0..5.0).contains(&column)
        && (0.0..7.0).contains(&row)
        && glyph[row as usize] >> (4 - column as u8) & 1 == 1
}
