//! Colour spaces that colour maps are interpolated in: linear RGB, CIE L\*a\*b\* (D65), Moreland's Msh and HSV.
//!
//! All functions take and return display-referred sRGB with channels in [0, 1].

/// D65 white point of sRGB, CIE XYZ.
const WHITE_XYZ: [f64; 3] = [0.9505, 1.0, 1.089];

/// CIE L\*a\*b\* of an sRGB colour.
pub fn lab_from_srgb(rgb: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = rgb.map(|c| if c > 0.04045 { ((c + 0.055) / 1.055).powf(2.4) } else { c / 12.92 });
    let xyz = [
        0.4124 * r + 0.3576 * g + 0.1805 * b,
        0.2126 * r + 0.7152 * g + 0.0722 * b,
        0.0193 * r + 0.1192 * g + 0.9505 * b,
    ];
    let f = |t: f64| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
    let [x, y, z] = [0, 1, 2].map(|i| f(xyz[i] / WHITE_XYZ[i]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The sRGB colour of a CIE L\*a\*b\* triple, clamped to the gamut.
pub fn srgb_from_lab([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let y = (lightness + 16.0) / 116.0;
    let f = |t: f64| if t.powi(3) > 0.008856 { t.powi(3) } else { (t - 16.0 / 116.0) / 7.787 };
    let fs = [y + a / 500.0, y, y - b / 200.0];
    let [x, y, z] = [0, 1, 2].map(|i| f(fs[i]) * WHITE_XYZ[i]);
    let linear = [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ];
    linear
        .map(|c| if c > 0.003_130_8 { 1.055 * c.powf(1.0 / 2.4) - 0.055 } else { 12.92 * c })
        .map(|c| c.clamp(0.0, 1.0))
}

/// Straight line between two colours in sRGB.
pub fn mix_srgb(from: [f64; 3], to: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| from[i] + (to[i] - from[i]) * t)
}

/// Straight line between two colours in CIE L\*a\*b\*.
pub fn mix_lab(from: [f64; 3], to: [f64; 3], t: f64) -> [f64; 3] {
    srgb_from_lab(mix_srgb(lab_from_srgb(from), lab_from_srgb(to), t))
}

/// Line between two colours in HSV. With `wrap` the hue goes the shorter way round the circle, else through the hues
/// between the two angles.
pub fn mix_hsv(from: [f64; 3], to: [f64; 3], t: f64, wrap: bool) -> [f64; 3] {
    let (mut from, mut to) = (hsv_from_rgb(from), hsv_from_rgb(to));
    if wrap && from[0] - to[0] > 0.5 {
        from[0] -= 1.0;
    } else if wrap && to[0] - from[0] > 0.5 {
        to[0] -= 1.0;
    }
    rgb_from_hsv(mix_srgb(from, to, t))
}

/// Moreland's diverging interpolation: a line in Msh, through white where two saturated colours differ in hue by more
/// than 60° (Moreland, "Diverging Color Maps for Scientific Visualization", ISVC 2009).
pub fn mix_diverging(from: [f64; 3], to: [f64; 3], t: f64) -> [f64; 3] {
    let (mut from, mut to) = (msh_from_lab(lab_from_srgb(from)), msh_from_lab(lab_from_srgb(to)));
    let mut t = t;
    if from[1] > 0.05 && to[1] > 0.05 && angle_between(from[2], to[2]) > std::f64::consts::FRAC_PI_3 {
        let middle = from[0].max(to[0]).max(88.0);
        if t < 0.5 {
            to = [middle, 0.0, 0.0];
            t *= 2.0;
        } else {
            from = [middle, 0.0, 0.0];
            t = 2.0 * t - 1.0;
        }
    }
    if from[1] < 0.05 && to[1] > 0.05 {
        from[2] = spun_hue(to, from[0]);
    } else if to[1] < 0.05 && from[1] > 0.05 {
        to[2] = spun_hue(from, to[0]);
    }
    srgb_from_lab(lab_from_msh(mix_srgb(from, to, t)))
}

fn msh_from_lab([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let magnitude = (lightness * lightness + a * a + b * b).sqrt();
    let saturation = if magnitude > 0.001 { (lightness / magnitude).clamp(-1.0, 1.0).acos() } else { 0.0 };
    let hue = if saturation > 0.001 { b.atan2(a) } else { 0.0 };
    [magnitude, saturation, hue]
}

fn lab_from_msh([magnitude, saturation, hue]: [f64; 3]) -> [f64; 3] {
    let chroma = magnitude * saturation.sin();
    [magnitude * saturation.cos(), chroma * hue.cos(), chroma * hue.sin()]
}

fn angle_between(a: f64, b: f64) -> f64 {
    let difference = (a - b).abs();
    if difference > std::f64::consts::PI { std::f64::consts::TAU - difference } else { difference }
}

/// The hue that an unsaturated end of the given magnitude needs so that lightness changes evenly towards `saturated`.
fn spun_hue(saturated: [f64; 3], unsaturated_magnitude: f64) -> f64 {
    let [magnitude, saturation, hue] = saturated;
    if magnitude >= unsaturated_magnitude - 0.1 {
        return hue;
    }
    let spin = saturation * (unsaturated_magnitude.powi(2) - magnitude.powi(2)).sqrt()
        / (magnitude * saturation.sin());
    if hue > -0.3 * std::f64::consts::PI { hue + spin } else { hue - spin }
}

/// Hue (in turns), saturation and value.
fn hsv_from_rgb([r, g, b]: [f64; 3]) -> [f64; 3] {
    let value = r.max(g).max(b);
    let range = value - r.min(g).min(b);
    if range <= 0.0 {
        return [0.0, 0.0, value];
    }
    let sixths = if value == r {
        ((g - b) / range).rem_euclid(6.0)
    } else if value == g {
        (b - r) / range + 2.0
    } else {
        (r - g) / range + 4.0
    };
    [sixths / 6.0, range / value, value]
}

fn rgb_from_hsv([hue_turns, saturation, value]: [f64; 3]) -> [f64; 3] {
    let sixths = hue_turns.rem_euclid(1.0) * 6.0;
    [5.0, 3.0, 1.0].map(|offset: f64| {
        let k = (offset + sixths).rem_euclid(6.0);
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: [f64; 3], expected: [f64; 3], tolerance: f64) {
        let off = [0, 1, 2].map(|i| (found[i] - expected[i]).abs());
        assert!(off.iter().all(|&d| d <= tolerance), "{found:?} is not {expected:?}");
    }

    #[test]
    fn lab_of_primaries_is_the_published_one() {
        assert_close(lab_from_srgb([1.0; 3]), [100.0, 0.0, 0.0], 0.02);
        assert_close(lab_from_srgb([1.0, 0.0, 0.0]), [53.24, 80.09, 67.20], 0.05);
        assert_close(lab_from_srgb([0.0, 0.0, 1.0]), [32.30, 79.19, -107.86], 0.05);
    }

    #[test]
    fn every_space_comes_back() {
        for i in 0..27 {
            let rgb = [i % 3, i / 3 % 3, i / 9].map(|c| f64::from(c) * 0.5);
            assert_close(srgb_from_lab(lab_from_srgb(rgb)), rgb, 2e-3);
            assert_close(rgb_from_hsv(hsv_from_rgb(rgb)), rgb, 1e-12);
            let lab = lab_from_srgb(rgb);
            assert_close(lab_from_msh(msh_from_lab(lab)), lab, 0.1);
        }
    }

    #[test]
    fn interpolations_end_at_their_ends() {
        let (from, to) = ([0.23, 0.3, 0.75], [0.7, 0.02, 0.15]);
        for mix in [mix_srgb, mix_lab, mix_diverging, |a, b, t| mix_hsv(a, b, t, false)] {
            assert_close(mix(from, to, 0.0), from, 2e-3);
            assert_close(mix(from, to, 1.0), to, 2e-3);
        }
    }

    #[test]
    fn hue_wraps_only_on_request() {
        let (red, magenta) = ([1.0, 0.0, 0.0], [1.0, 0.0, 1.0]);
        assert_close(mix_hsv(red, magenta, 0.5, true), [1.0, 0.0, 0.5], 1e-9);
        assert_close(mix_hsv(red, magenta, 0.4, false), [0.0, 1.0, 0.0], 1e-9);
    }
}
