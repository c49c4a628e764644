//! Projectors of light-field displays, seen directly and in mirrors: rays with multiple centres of projection, with skipping and
//! without.

use crate::device::on_device;
use crate::report::{Case, Report};
use crate::scene::*;
use glam::{DAffine3, DMat3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::lightfield::ProjectorArray;
use wheatstone_core::lightfield::projectors::{Description, ImageRect, Packing, Projector, VirtualViewer};
use wheatstone_core::lit_sphere::Style;
use wheatstone_core::scene::{Mode, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::view::View;
use wheatstone_core::volume::{VoxelType, Window};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{GpuVolume, Leap, Sources, TexelFormat};

/// Largest difference of a channel that leaping may make: one level of an 8-bit picture.
const LARGEST_DIFFERENCE: f64 = 1.0 / 255.0;

/// What six projectors, of which the outer two are seen in mirrors, show of a world that is turned before the screen: a volume of
/// 1 m reaches to both sides of it.
pub(crate) fn views() -> Vec<View> {
    let straight = ImageRect { left_m: -0.8, right_m: 0.8, down_m: -0.6, up_m: 0.6 };
    let reversed = ImageRect { left_m: 0.8, right_m: -0.8, ..straight };
    let projector = |id: u32| Projector {
        id,
        emitter_m: [0.3 * (f64::from(id) - 2.5), 0.0, -2.0],
        image: if (1..5).contains(&id) { straight } else { reversed },
    };
    let display_from_world =
        DAffine3::from_mat3_translation(DMat3::from_rotation_y(0.4), DVec3::new(0.05, -0.1, 0.1));
    ProjectorArray::new(Description {
        wheatstone_projector_array: 1,
        screen_size_m: [1.6, 1.2],
        pixel_size_m: 0.03,
        beam_angle_deg: 6.0,
        viewer: VirtualViewer { height_m: 0.2, distance_m: 1.5 },
        image_size_px: [51, 37],
        projectors: (0..6).map(projector).collect(),
        packing: Packing { frame_size_px: [51, 45], header_rows: 8 },
    })
    .unwrap()
    .views(display_from_world)
}

#[test]
fn projectors_show_what_they_do_in_the_reference() {
    let volume = blob_volume([33, 28, 24], oblique([1.0, 1.2, 0.9]), VoxelType::U8);
    let format = TexelFormat::Rgba8UnormQuads;
    // Above the haze, so that there is empty space.
    let window = Window::new(60.0, 250.0).unwrap();
    let plain = Settings::new(window, transfer(0.6));
    let glass = Shading::LitSphere { low: Style::Glass, high: Style::Glass };
    let phong = Settings { shading: Shading::Phong, ..plain.clone() };
    let settings = [
        ("composite", plain.clone()),
        ("composite phong", phong.clone()),
        ("composite glass", Settings { shading: glass, ..plain.clone() }),
        ("isosurface phong", Settings { mode: Mode::Isosurface { isovalue: 0.2 }, ..phong }),
        ("mip", Settings { mode: Mode::Mip, ..plain.clone() }),
        ("xray", Settings { mode: Mode::XRay, ..plain }),
    ];
    on_device(|gpu, renderer| {
        let mut report = Report::default();
        let uploaded = GpuVolume::upload_as(gpu, &volume, format, &mut |_, _| {}).unwrap();
        let kernels = SkipKernels::new(gpu).unwrap();
        let block = BlockSize::cube(4).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, block).unwrap();
        for (name, settings) in &settings {
            let parameters = CastParameters::new(settings, &placement(&volume));
            let map = builder.map(gpu, &parameters, Structure::Anisotropic).unwrap();
            let leap = match settings.mode {
                Mode::Mip => Leap::IdleBlocks(builder.values()),
                _ => Leap::EmptyBlocks(&map),
            };
            let plain = Sources::volume(&uploaded);
            let [casts, leapt] = [plain, Sources { leap, ..plain }].map(|sources| {
                let prepared = renderer.prepare(gpu, &sources, parameters.clone()).unwrap();
                renderer.render_to_host(gpu, &prepared, &views()).unwrap()
            });
            let expected = cast_on_cpu(&volume, format, &parameters, &views());
            for (id, view) in views().into_iter().enumerate() {
                let name = format!("{name}, projector {id}");
                let lit = casts[id].image.color.iter().filter(|pixel| pixel[3] > 0.05).count();
                assert!(lit > 100, "{name}: only {lit} pixels show anything");
                let difference = largest_difference(&casts[id], &leapt[id]);
                assert!(difference <= LARGEST_DIFFERENCE, "{name}: leaping changes {difference}");
                assert!(leapt[id].samples < casts[id].samples, "{name}: nothing was leapt over");
                let case = Case { name, format, settings: settings.clone(), view };
                report.compare(&volume, &case, &expected[id], &casts[id]);
            }
        }
        report.finish("projectors");
    });
}
