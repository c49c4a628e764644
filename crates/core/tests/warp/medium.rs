//! Beer–Lambert there and back.

use glam::DVec4;
use proptest::prelude::*;
use wheatstone_core::warp::Medium;

proptest! {
    #[test]
    fn a_colour_comes_back(rgb in prop::array::uniform3(0.0..1.0), alpha in 0.0..1.0, length_m in 1e-4..10.0) {
        let [r, g, b] = rgb;
        let color = DVec4::new(r * alpha, g * alpha, b * alpha, alpha);
        let back = Medium::from_color(color, length_m).color(length_m);
        prop_assert!((back - color).abs().max_element() < 1e-6, "{color} {back}");
    }

    #[test]
    fn faint_and_opaque_colours_come_back(digits in 0.0..12.0_f64, length_m in 1e-4..10.0) {
        let faint = DVec4::new(0.5, 0.2, 0.0, 1.0) * 10.0_f64.powf(-digits);
        let back = Medium::from_color(faint, length_m).color(length_m);
        prop_assert!((back - faint).abs().max_element() < 1e-6 * faint.w, "{faint} {back}");
        let through = 10.0_f64.powf(-digits);
        let dense = DVec4::new(0.5, 0.2, 0.0, 1.0) * (1.0 - through);
        let back = Medium::from_color(dense, length_m).color(length_m);
        prop_assert!((back - dense).abs().max_element() < 1e-6, "{dense} {back}");
    }

    #[test]
    fn two_halves_are_the_whole(alpha in 0.0..1.0, length_m in 1e-4..10.0, part in 0.0..1.0) {
        let medium = Medium::from_color(DVec4::splat(alpha), length_m);
        let [front, back] = [part, 1.0 - part].map(|part| medium.color(part * length_m));
        let both = front + (1.0 - front.w) * back;
        prop_assert!((both - medium.color(length_m)).abs().max_element() < 1e-12);
    }
}

#[test]
fn nothing_is_clear_whatever_its_length() {
    for (alpha, length_m) in
        [(0.0, 1.0), (-1.0, 1.0), (0.5, 0.0), (0.5, -1.0), (f64::NAN, 1.0), (0.5, f64::NAN)]
    {
        assert_eq!(Medium::from_color(DVec4::splat(alpha), length_m), Medium::default());
    }
    assert_eq!(Medium::default().color(1.0), DVec4::ZERO);
}
