//! What lenses hide, in pixels.

use wheatstone_core::headset::HiddenArea;
use wheatstone_core::view::{Frustum, PixelRect};

const FRUSTUM: Frustum =
    Frustum { left: -1.2, right: 0.8, down: -1.0, up: 1.0, near_m: 0.01, far_m: f64::INFINITY };

/// 50 pixels per unit of tangent.
const SIZE: [u32; 2] = [100, 100];

/// Everything that is beyond a radius about the view's axis, as a ring of triangles out to a square.
fn beyond(radius: f32) -> HiddenArea {
    let count = 64_u32;
    let corners = (0..count).flat_map(|index| {
        let (sin, cos) = (index as f32 / count as f32 * std::f32::consts::TAU).sin_cos();
        let outwards = 2.0 / sin.abs().max(cos.abs());
        [[radius * cos, radius * sin], [outwards * cos, outwards * sin]]
    });
    let triangles = (0..count).flat_map(|index| {
        let [a, b] = [2 * index, 2 * ((index + 1) % count)];
        [[a, a + 1, b], [b, a + 1, b + 1]]
    });
    HiddenArea { corners: corners.collect(), triangles: triangles.collect() }
}

fn contains(rects: &[PixelRect], x: u32, y: u32) -> usize {
    rects.iter().filter(|rect| rect.columns.contains(&x) && rect.rows.contains(&y)).count()
}

#[test]
fn without_anything_hidden_all_is_visible() {
    let all = [PixelRect { columns: 0..100, rows: 0..100 }];
    assert_eq!(HiddenArea::default().visible(&FRUSTUM, SIZE), all);
}

#[test]
fn every_pixel_that_can_be_seen_is_in_one_rectangle_and_most_that_cannot_in_none() {
    let radius = 0.6;
    let visible = beyond(radius as f32).visible(&FRUSTUM, SIZE);
    let mut hidden = 0;
    for (x, y) in (0..100).flat_map(|y| (0..100).map(move |x| (x, y))) {
        let tangents = [f64::from(x) + 0.5, f64::from(y) + 0.5].map(|at| at / 50.0);
        let distance = (tangents[0] - 1.2).hypot(1.0 - tangents[1]);
        let times = contains(&visible, x, y);
        assert!(times <= 1);
        if distance < radius {
            assert_eq!(times, 1, "{x} {y}");
        }
        hidden += usize::from(times == 0);
    }
    // The circle covers 28 of 100 pixels; about it are rectangles of 16 rows.
    assert!(hidden > 5500, "{hidden}");
}

#[test]
fn bands_that_are_hidden_are_in_no_rectangle_whatever_the_rounding() {
    // A fifth of a unit at the top and at the left, of two triangles each.
    let corners =
        vec![[-1.2, 1.0], [0.8, 1.0], [-1.2, 0.8], [0.8, 0.8], [-1.0, 1.0], [-1.0, -1.0], [-1.2, -1.0]];
    let triangles = vec![[0, 1, 2], [1, 2, 3], [0, 4, 5], [0, 5, 6]];
    let visible = HiddenArea { corners, triangles }.visible(&FRUSTUM, SIZE);
    // Ten pixels each, of which that next to what is visible is in the rectangle.
    assert_eq!(visible, [PixelRect { columns: 9..100, rows: 0..100 }]);
    let top = HiddenArea {
        corners: vec![[-2.0, 1.0], [2.0, 1.0], [-2.0, 0.0], [2.0, 0.0]],
        triangles: vec![[0, 1, 2], [1, 2, 3]],
    };
    assert_eq!(top.visible(&FRUSTUM, SIZE), [PixelRect { columns: 0..100, rows: 48..100 }]);
}

#[test]
fn a_picture_that_is_hidden_has_no_pixels() {
    assert_eq!(beyond(0.0).visible(&FRUSTUM, SIZE), []);
}
