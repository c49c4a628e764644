//! Lit spheres of every style, and boundary enhancement beside every shading: the GPU's picture is the reference's.

use crate::projectors;
use crate::report::{Case, check};
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::lit_sphere::Style;
use wheatstone_core::scene::{BoundaryEnhancement, GradientMethod, Mode, Settings, Shading};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Volume, VoxelType, Window};
use wheatstone_render::TexelFormat;

const BOUNDARIES: BoundaryEnhancement = BoundaryEnhancement { inside: 0.2, gain: 15.0, exponent: 2 };

fn blobs() -> Volume {
    blob_volume([33, 28, 24], oblique([1.0, 1.2, 0.9]), VoxelType::U8)
}

fn views() -> [(&'static str, View); 3] {
    let size = [61, 47];
    let parallel = look(DVec3::new(0.3, -0.9, 0.5), DVec3::ZERO, orthographic(1.3, size), size);
    [("outside", outside()), ("parallel", parallel), ("projector", projectors::views()[5])]
}

fn cases(named: impl IntoIterator<Item = (String, Settings)>) -> Vec<Case> {
    let seen = |(name, settings): (String, Settings)| {
        views().map(|(seen, view)| Case {
            name: format!("{name}, {seen}"),
            format: TexelFormat::Rgba8UnormQuads,
            settings: settings.clone(),
            view,
        })
    };
    named.into_iter().flat_map(seen).collect()
}

#[test]
fn styles() {
    let volume = blobs();
    // Values beyond the window are those of its ends.
    let window = Window::new(40.0, 190.0).unwrap();
    let of = |low: Style, high: Style| {
        let plain = Settings::new(window, transfer(0.6));
        let settings = Settings { shading: Shading::LitSphere { low, high }, ..plain };
        let iso = Settings { mode: Mode::Isosurface { isovalue: 0.4 }, ..settings.clone() };
        let name = |mode: &str| format!("{mode}, {} to {}", low.name(), high.name());
        [(name("composite"), settings), (name("isosurface"), iso)]
    };
    let same = Style::ALL.iter().flat_map(|&style| of(style, style));
    check(
        "styles",
        &volume,
        cases(same.chain(of(Style::Ink, Style::Clay)).chain(of(Style::Clay, Style::Glass))),
    );
}

#[test]
fn boundaries() {
    let volume = blobs();
    let plain =
        Settings { boundaries: Some(BOUNDARIES), ..Settings::new(volume.full_window(), transfer(0.6)) };
    let shadings = [
        Shading::None,
        Shading::Phong,
        Shading::Shadow,
        Shading::LitSphere { low: Style::Porcelain, high: Style::Glass },
    ];
    let shaded = shadings.map(|shading| (format!("{shading:?}"), Settings { shading, ..plain.clone() }));
    let linear = BoundaryEnhancement { inside: 0.0, gain: 5.0, exponent: 1 };
    let others = [
        ("two-dimensional", Settings { transfer: transfer_2d(), ..plain.clone() }),
        ("pre-integrated", Settings { preintegrated: true, ..plain.clone() }),
        ("tetrahedron", Settings { gradient: GradientMethod::Tetrahedron, ..plain.clone() }),
        ("exponent 1, nothing inside", Settings { boundaries: Some(linear), ..plain }),
    ]
    .map(|(name, settings)| (name.to_owned(), settings));
    check("boundaries", &volume, cases(shaded.into_iter().chain(others)));
}
