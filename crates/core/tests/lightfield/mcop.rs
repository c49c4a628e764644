//! Multiple centres of projection: LF Eq. 1 and 4 agree with each other and with what is cast.

use crate::scene::{Scene, byte_window, display};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::phantom::{BOX_HI, BOX_LO, Phantom};
use wheatstone_core::reference::{Aids, Leap};
use wheatstone_core::scene::{Mode, Placement, Settings, Shading};
use wheatstone_core::skip::{BlockRanges, BlockSize, Occupancy, SkipMap, Structure, Visibility};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::{Mcop, PixelRect, Projection, RayField, View, Viewpoint};
use wheatstone_core::volume::{Encoding, StorageKind, Volume};

fn mcop(view: &View) -> Mcop {
    let Projection::Mcop(mcop) = view.projection else { panic!("views of projectors have their projection") };
    mcop
}

proptest! {
    #[test]
    fn a_point_is_on_the_ray_of_the_pixel_that_shows_it(
        place in prop::array::uniform3(-0.1_f64..0.1),
        index in 0_usize..12,
        turn in -0.5_f64..0.5,
    ) {
        let display_from_world = DAffine3::from_mat3_translation(DMat3::from_rotation_y(turn), DVec3::new(0.01, 0.02, -0.01));
        let view = display(12, 3.0, [40, 30]).views(display_from_world)[index];
        let point = display_from_world.inverse().transform_point3(place.into());
        let pixel = view.pixel_position(point).unwrap();
        let (origin, direction) = RayField::new(&view, DAffine3::IDENTITY).at(pixel.x, pixel.y);
        prop_assert!((origin + direction * -place[2] - point).length() < 1e-12);
        // The ray meets the vertical line through the emitter and the horizontal one through the viewer.
        let m = mcop(&view);
        let in_display = |depth_m: f64| display_from_world.transform_point3(origin + direction * depth_m);
        prop_assert!((in_display(-m.emitter_z_m).x - m.emitter_x_m).abs() < 1e-12);
        prop_assert!((in_display(-m.viewer_z_m).y - m.viewer_y_m).abs() < 1e-12);
        let corner = view.pixel_position(display_from_world.inverse().transform_point3(DVec3::new(m.left_m, m.up_m, 0.0)));
        prop_assert!(corner.unwrap().length() < 1e-9);
    }

    #[test]
    fn nothing_is_shown_that_is_not_between_the_emitter_and_the_viewer(z in prop::sample::select(vec![-0.5, -0.6, 0.6, 0.7])) {
        let view = display(12, 3.0, [40, 30]).views(DAffine3::IDENTITY)[3];
        prop_assert_eq!(view.pixel_position(DVec3::new(0.0, 0.0, z)), None);
    }

    #[test]
    fn rays_that_meet_a_box_are_in_its_rectangle(
        middle in prop::array::uniform3(-0.06_f64..0.06),
        half in prop::array::uniform3(0.01_f64..0.05),
        index in 0_usize..12,
    ) {
        let view = display(12, 3.0, [40, 30]).views(DAffine3::IDENTITY)[index];
        let (middle, half) = (DVec3::from(middle), DVec3::from(half));
        let corners = (0..8).map(|i| middle + half * DVec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 })));
        let rect = PixelRect::around(&view, corners);
        let rays = RayField::new(&view, DAffine3::IDENTITY);
        for (x, y) in (0..30_u32).flat_map(|y| (0..40_u32).map(move |x| (x, y))) {
            let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let (a, b) = ((middle - half - origin) / direction, (middle + half - origin) / direction);
            if a.min(b).max_element() <= a.max(b).min_element() {
                prop_assert!(rect.columns.contains(&x) && rect.rows.contains(&y), "{} {} {:?}", x, y, rect);
            }
        }
    }
}

/// Places of the box's edges in texture space: twelve edges, each from one corner to another.
fn edges() -> Vec<[DVec3; 2]> {
    let corner =
        |bits: usize| DVec3::from([0, 1, 2].map(|axis| if bits >> axis & 1 == 0 { BOX_LO } else { BOX_HI }));
    let of_corner = |bits: usize| {
        (0..3)
            .filter(move |axis| bits >> axis & 1 == 0)
            .map(move |axis| [corner(bits), corner(bits | 1 << axis)])
    };
    (0..8).flat_map(of_corner).collect()
}

fn distance_to_segment(point: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let t = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (point - a - t * along).length()
}

/// How far beside a predicted position what is pictured there is, pixels: the centre of brightness across an edge.
fn beside(level: impl Fn(DVec2) -> f64, at: DVec2, across: DVec2) -> f64 {
    let steps = (-30..=30).map(|i| 0.1 * f64::from(i));
    let (weight, moment) = steps.fold((0.0, 0.0), |(weight, moment), offset| {
        let brightness = level(at + offset * across);
        (weight + brightness, moment + brightness * offset)
    });
    assert!(weight > 1.0, "nothing is pictured at {at}");
    moment / weight
}

#[test]
fn a_wire_box_is_cast_where_the_equation_projects_it_on_every_projector() {
    const SIZE: [u32; 2] = [96, 72];
    /// How near another edge may come to one that is looked at, pixels.
    const ALONE_PX: f64 = 8.0;
    let volume = Phantom::WireBox.cube(64).unwrap();
    let transfer = TransferFunction::ramp(0.0, 1.0).unwrap();
    let settings =
        Settings { mode: Mode::Mip, sampling_factor: 2.0, ..Settings::new(byte_window(), transfer) };
    let scene = Scene::new(&volume, 0.2, &settings);
    let world_from_texture =
        Placement::new(&volume, crate::scene::world_from_patient(&volume, 0.2)).world_from_texture();
    // Turned, or edges would hide behind each other.
    let turn = DAffine3::from_mat3(DMat3::from_rotation_x(0.35) * DMat3::from_rotation_y(0.4));
    let views = display(12, 3.0, SIZE).views(turn);
    let casts = scene.caster.cast(&scene.parameters, &Aids::default(), &views);
    for (index, (view, cast)) in views.iter().zip(&casts).enumerate() {
        let pixel_of =
            |texture: DVec3| view.pixel_position(world_from_texture.transform_point3(texture)).unwrap();
        let level = |at: DVec2| {
            let sample = |x: f64, y: f64| {
                let inside = x >= 0.0 && y >= 0.0 && x < f64::from(SIZE[0]) && y < f64::from(SIZE[1]);
                if inside {
                    f64::from(cast.image.color[(y as u32 * SIZE[0] + x as u32) as usize][0])
                } else {
                    0.0
                }
            };
            let (corner, part) = ((at - 0.5).floor(), at - 0.5 - (at - 0.5).floor());
            let row = |y: f64| sample(corner.x, y) * (1.0 - part.x) + sample(corner.x + 1.0, y) * part.x;
            row(corner.y) * (1.0 - part.y) + row(corner.y + 1.0) * part.y
        };
        // Long straight lines are curved in the picture: edges are followed in short pieces.
        let pieces =
            |[a, b]: [DVec3; 2]| (0..16).map(move |i| [i, i + 1].map(|end| a.lerp(b, f64::from(end) / 16.0)));
        let (mut looked_at, mut worst) = (0, 0.0_f64);
        for (number, edge) in edges().into_iter().enumerate() {
            for piece in pieces(edge).skip(2).take(12) {
                let [from, to] = piece.map(pixel_of);
                let middle = 0.5 * (from + to);
                let others = edges().into_iter().enumerate().filter(|&(other, _)| other != number);
                let is_alone = others
                    .flat_map(|(_, other)| pieces(other))
                    .all(|other| distance_to_segment(middle, other.map(pixel_of)) > ALONE_PX);
                let is_inside = middle.cmpge(DVec2::splat(4.0)).all()
                    && middle.cmple(DVec2::from(SIZE.map(f64::from)) - 4.0).all();
                let is_long = (to - from).length() > 1.0;
                if !is_alone || !is_inside || !is_long {
                    continue;
                }
                let across = (to - from).perp() / (to - from).length();
                worst = worst.max(beside(level, middle, across).abs());
                looked_at += 1;
            }
        }
        assert!(looked_at >= 15, "projector {index}: only {looked_at} pieces of edges are alone");
        assert!(worst < 0.5, "projector {index}: an edge is {worst} pixels beside its projection");
    }
}

#[test]
fn lanes_of_either_width_and_leaps_make_the_same_picture() {
    let volume = Phantom::Beetle.cube(48).unwrap();
    let transfer = TransferFunction::ramp(0.2, 0.9).unwrap();
    let full = TransferFunction::ramp(0.0, 1.0).unwrap();
    for (mode, shading) in
        [(Mode::Composite, Shading::Phong), (Mode::Mip, Shading::None), (Mode::XRay, Shading::None)]
    {
        let transfer = if mode == Mode::Composite { &transfer } else { &full };
        let settings = Settings { mode, shading, ..Settings::new(byte_window(), transfer.clone()) };
        let scene = Scene::new(&volume, 0.2, &settings);
        let views = [
            display(12, 3.0, [40, 30]).views(DAffine3::IDENTITY)[1],
            display(12, 3.0, [40, 30]).views(DAffine3::IDENTITY)[6],
        ];
        let exact = scene.caster.cast_exactly(&scene.parameters, &Aids::default(), &views);
        let wide = scene.caster.cast(&scene.parameters, &Aids::default(), &views);
        let most = |a: &[[f32; 4]], b: &[[f32; 4]]| {
            a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
        };
        for (a, b) in exact.iter().zip(&wide) {
            assert!(a.image.color.iter().any(|pixel| pixel[0] > 0.01), "{mode:?}: nothing is seen");
            assert!(most(&a.image.color, &b.image.color) < 0.01, "{mode:?}");
        }
        if mode == Mode::Composite {
            let map = skip_map(&volume, &scene.parameters);
            let leapt = scene.caster.cast_exactly(&scene.parameters, &Leap::EmptyBlocks(&map).into(), &views);
            for (a, b) in exact.iter().zip(&leapt) {
                assert_eq!(a.image, b.image);
                assert!(b.samples < a.samples / 2, "{} of {}", b.samples, a.samples);
            }
        }
    }
}

fn skip_map(volume: &Volume, parameters: &CastParameters) -> SkipMap {
    let kind = StorageKind::lossless_for(volume);
    let ranges = BlockRanges::of_values(volume, kind, BlockSize::cube(4).unwrap());
    let normalised = Encoding::new(volume, kind).normalised_from_stored(parameters.window);
    let occupancy = Occupancy::new(ranges.normalised(normalised), None, &Visibility::new(parameters));
    SkipMap::new(&occupancy, Structure::Anisotropic)
}

#[test]
fn highlights_follow_the_eye_that_sees_them() {
    let view = display(12, 3.0, [40, 30]).views(DAffine3::IDENTITY)[4];
    let m = mcop(&view);
    let rays = RayField::new(&view, DAffine3::IDENTITY);
    for x in [0.5, 13.0, 39.5] {
        let (origin, direction) = rays.at(x, 15.0);
        let eye = origin - m.viewer_z_m * direction;
        let viewpoint = rays.viewpoint.truncate() + x * rays.viewpoint_dx;
        assert!((eye - viewpoint).length() < 1e-12, "{eye} {viewpoint}");
    }
    let fixed = View { shaded_from: Some(Viewpoint::At(DVec3::Z)), ..view };
    let rays = RayField::new(&fixed, DAffine3::IDENTITY);
    assert_eq!((rays.viewpoint.truncate(), rays.viewpoint_dx), (DVec3::Z, DVec3::ZERO));
}
