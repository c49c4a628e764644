//! Every mode, shading, classifier, gradient, texel format, voxel type, projection and clip: the GPU's picture, depths
//! and sample counts are the reference's.

use crate::device::on_device;
use crate::report::{Case, Report, check};
use crate::scene::*;
use glam::{DAffine3, DVec3, Vec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::gradient_map::{GradientDepth, GradientMap};
use wheatstone_core::lit_sphere::Style;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Caster, HeldGradientMap};
use wheatstone_core::scene::{Clip, ClipPlane, GradientMethod, Light, Mode, Settings, Shading};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::Rig;
use wheatstone_core::volume::{StorageKind, Volume, VoxelType, Window};
use wheatstone_render::{GpuGradientMap, GpuVolume, Leap, Sources, TexelFormat};

const DIMS: [usize; 3] = [33, 28, 24];

fn blobs_u16() -> Volume {
    blob_volume(DIMS, spacing([1.0; 3]), VoxelType::U16)
}

fn case(name: impl Into<String>, settings: Settings) -> Case {
    Case { name: name.into(), format: TexelFormat::R16Unorm, settings, view: outside() }
}

fn plain(volume: &Volume) -> Settings {
    Settings::new(volume.full_window(), transfer(0.6))
}

/// A choice of settings that runs the parts of the kernel that texel formats, views and clips touch.
fn few_settings(volume: &Volume) -> Vec<(&'static str, Settings)> {
    let plain = plain(volume);
    let iso = Mode::Isosurface { isovalue: 0.4 };
    vec![
        ("composite", plain.clone()),
        ("composite phong", Settings { shading: Shading::Phong, ..plain.clone() }),
        ("composite shadow", Settings { shading: Shading::Shadow, ..plain.clone() }),
        ("iso phong", Settings { mode: iso, shading: Shading::Phong, ..plain.clone() }),
        ("mip", Settings { mode: Mode::Mip, ..plain.clone() }),
        ("xray", Settings { mode: Mode::XRay, ..plain }),
    ]
}

#[test]
fn modes_shadings_and_classifiers() {
    let volume = blobs_u16();
    let shadings = [
        Shading::None,
        Shading::Phong,
        Shading::Shadow,
        Shading::Ambient,
        Shading::Directional { directions: 4 },
        Shading::LitSphere { low: Style::Metal, high: Style::Glass },
    ];
    let mut cases = Vec::new();
    for shading in shadings {
        let plain = Settings { shading, ..plain(&volume) };
        let two_dimensional = Settings { transfer: transfer_2d(), ..plain.clone() };
        let preintegrated = Settings { preintegrated: true, ..plain.clone() };
        let iso = Settings { mode: Mode::Isosurface { isovalue: 0.4 }, ..plain.clone() };
        for (name, settings) in
            [("1d", plain), ("2d", two_dimensional), ("pre-integrated", preintegrated), ("iso", iso)]
        {
            cases.push(case(format!("{name} {shading:?}"), settings));
        }
    }
    for mode in [Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay] {
        cases.push(case(format!("{mode:?}"), Settings { mode, ..plain(&volume) }));
        let transfer = transfer_2d();
        cases.push(case(format!("{mode:?} 2d"), Settings { mode, transfer, ..plain(&volume) }));
    }
    let tetrahedron =
        Settings { gradient: GradientMethod::Tetrahedron, shading: Shading::Phong, ..plain(&volume) };
    let iso = Mode::Isosurface { isovalue: 0.3 };
    cases.push(case("tetrahedron 1d", tetrahedron.clone()));
    cases.push(case("tetrahedron 2d", Settings { transfer: transfer_2d(), ..tetrahedron.clone() }));
    cases.push(case("tetrahedron iso", Settings { mode: iso, ..tetrahedron }));
    check("modes, shadings and classifiers", &volume, cases);
}

/// The GPU's texels of 8 bits are half floats on software Vulkan, so that they are interpolated as well as the reference's.
#[test]
fn gradient_maps() {
    let formats =
        [(VoxelType::U8, TexelFormat::Rgba8UnormQuads), (VoxelType::U16, TexelFormat::R16FloatOf16Bit)];
    let methods = [GradientMethod::CentralDifferences, GradientMethod::Tetrahedron];
    on_device(|gpu, renderer| {
        let mut report = Report::default();
        for ((voxel_type, format), gradient) in
            formats.into_iter().flat_map(|format| methods.map(|method| (format, method)))
        {
            let volume = blob_volume(DIMS, spacing([1.0, 0.8, 1.3]), voxel_type);
            let uploaded = GpuVolume::upload_as(gpu, &volume, format, &mut |_, _| {}).unwrap();
            let caster = Caster::with_storage(&volume, storage_kind(format));
            for (depth, shading) in
                [(GradientDepth::Bits8, Shading::Phong), (GradientDepth::Bits16, Shading::Shadow)]
            {
                let settings = Settings { gradient, shading, transfer: transfer_2d(), ..plain(&volume) };
                let name = format!("{voxel_type} as {format:?}, {gradient:?}, {depth:?}, {shading:?}");
                let case = Case { name, format, settings, view: outside() };
                let parameters = CastParameters::new(&case.settings, &placement(&volume));
                let map = GradientMap::new(&volume, storage_kind(format), gradient, depth);
                let held = HeldGradientMap::new(&map);
                let aids = Aids { gradient_map: Some(&held), ..Aids::default() };
                let cpu = caster.cast_exactly(&parameters, &aids, &[case.view]).remove(0);
                let map = GpuGradientMap::new(gpu, &uploaded, gradient, depth).unwrap();
                let sources = Sources { volume: &uploaded, gradient_map: Some(&map), leap: Leap::Nothing };
                let prepared = renderer.prepare(gpu, &sources, parameters).unwrap();
                let found = renderer.render_to_host(gpu, &prepared, &[case.view]).unwrap().remove(0);
                report.compare(&volume, &case, &cpu, &found);
            }
        }
        report.finish("gradient maps");
    });
}

#[test]
fn lights_steps_thresholds_and_windows() {
    let volume = blobs_u16();
    let plain = plain(&volume);
    let phong = Settings { shading: Shading::Phong, ..plain.clone() };
    let shadow = Settings { shading: Shading::Shadow, ..plain.clone() };
    let iso = Settings { mode: Mode::Isosurface { isovalue: 0.5 }, ..phong.clone() };
    let light = Light::Directional(Vec3::new(0.9, -0.3, 0.2));
    let cases = vec![
        case("phong under a light", Settings { light, ..phong.clone() }),
        case("shadow of a light", Settings { light, ..shadow.clone() }),
        case("iso under a light, red", Settings { light, surface_rgb: Some([0.9, 0.2, 0.1]), ..iso.clone() }),
        case("directional 0", Settings { shading: Shading::Directional { directions: 0 }, ..plain.clone() }),
        case("directional 1", Settings { shading: Shading::Directional { directions: 1 }, ..plain.clone() }),
        case(
            "directional 64",
            Settings { shading: Shading::Directional { directions: 64 }, ..plain.clone() },
        ),
        case("f = 0.3", Settings { sampling_factor: 0.3, ..plain.clone() }),
        case("f = 2.7", Settings { sampling_factor: 2.7, ..phong.clone() }),
        case("iso f = 0.3", Settings { sampling_factor: 0.3, ..iso.clone() }),
        case("no early termination", Settings { early_termination: None, ..plain.clone() }),
        case("early termination at 0.5", Settings { early_termination: Some(0.5), ..phong.clone() }),
        case("narrow window", Settings { window: Window::new(9000.0, 22_000.0).unwrap(), ..phong.clone() }),
        case("wide window", Settings { window: Window::new(-70_000.0, 90_000.0).unwrap(), ..phong }),
        case("opaque", Settings { transfer: transfer(1.0), ..plain.clone() }),
        case(
            "nothing visible",
            Settings { transfer: TransferFunction::ramp(2.0, 3.0).unwrap(), ..plain.clone() },
        ),
        case("grey ramp", Settings { transfer: TransferFunction::ramp(0.1, 1.0).unwrap(), ..shadow }),
        case("iso above all", Settings { mode: Mode::Isosurface { isovalue: 1.5 }, ..plain.clone() }),
        case("iso below all", Settings { mode: Mode::Isosurface { isovalue: -0.5 }, ..plain }),
    ];
    check("lights, steps, thresholds and windows", &volume, cases);
}

#[test]
fn texel_formats_and_voxel_types() {
    use TexelFormat::{R8Unorm, R16FloatOf8Bit, R16FloatOf16Bit, R16Unorm, R32Float, Rgba8UnormQuads};
    let pairs = [
        (VoxelType::U8, vec![Rgba8UnormQuads, R8Unorm, R16FloatOf8Bit, R16Unorm, R32Float]),
        (VoxelType::U16, vec![R8Unorm, R16FloatOf8Bit, R16Unorm, R16FloatOf16Bit, R32Float]),
        (VoxelType::I16, vec![R16Unorm, R16FloatOf16Bit]),
        (VoxelType::F32, vec![R8Unorm, R16Unorm, R16FloatOf16Bit, R32Float]),
    ];
    on_device(|gpu, renderer| {
        let capabilities = gpu.capabilities().clone();
        let is_offered = |format| match format {
            R16Unorm => capabilities.has_16bit_norm,
            R32Float => capabilities.has_f32_filtering,
            _ => true,
        };
        let (mut narrow, mut wide) = (Report::default(), Report::default());
        for (voxel_type, formats) in pairs {
            let volume = blob_volume(DIMS, spacing([1.0; 3]), voxel_type);
            for format in formats.into_iter().filter(|&format| is_offered(format)) {
                // A driver compiles a kernel anew for each format: three kernels are enough here.
                let kernels = ["composite phong", "iso phong", "mip"];
                for (name, settings) in
                    few_settings(&volume).into_iter().filter(|(name, _)| kernels.contains(name))
                {
                    let name = format!("{name} {voxel_type} as {format:?}");
                    let report = if format == R8Unorm { &mut narrow } else { &mut wide };
                    report.run(gpu, renderer, &volume, &Case { name, format, settings, view: outside() });
                }
            }
        }
        narrow.finish("8-bit texels");
        wide.finish("16-bit and float texels");
    });
}

#[test]
fn projections_eyes_and_picture_sizes() {
    let volume = blobs_u16();
    let odd = [61, 47];
    let middle = DVec3::ZERO;
    let eye = DVec3::new(-0.7, 0.5, 1.0);
    let views = [
        (
            "inside",
            look(DVec3::new(0.05, 0.1, -0.1), DVec3::new(-0.5, -0.2, 0.6), perspective(1.5, odd), odd),
        ),
        (
            "inside along x",
            look(DVec3::new(0.1, 0.02, 0.03), DVec3::new(9.0, 0.02, 0.03), perspective(1.5, odd), odd),
        ),
        ("off axis", look(eye, middle, off_axis(0.9, odd, 0.35), odd)),
        ("along z", look(DVec3::Z * 1.5, middle, perspective(0.9, odd), odd)),
        ("parallel", look(eye, middle, orthographic(1.3, odd), odd)),
        ("parallel along x", look(DVec3::X, middle, orthographic(1.1, odd), odd)),
        ("parallel from inside", look(DVec3::new(0.01, 0.02, 0.03), eye, orthographic(1.1, odd), odd)),
        ("away from it", look(eye, 3.0 * eye, perspective(0.9, odd), odd)),
        ("from afar", look(eye * 300.0, middle, perspective(0.004, odd), odd)),
        ("on its face", look(DVec3::new(0.0, 0.0, 0.5), middle, perspective(1.0, odd), odd)),
        ("1 by 1", look(eye, middle, perspective(0.1, [1, 1]), [1, 1])),
        ("1 by 50", look(eye, middle, perspective(0.9, [1, 50]), [1, 50])),
        ("96 by 3", look(eye, middle, perspective(0.1, [96, 3]), [96, 3])),
    ];
    let mut cases = Vec::new();
    for (view_name, view) in views {
        for (name, settings) in few_settings(&volume) {
            cases.push(Case { view, ..case(format!("{name} {view_name}"), settings) });
        }
    }
    check("projections, eyes and picture sizes", &volume, cases);
}

#[test]
fn eyes_of_rigs() {
    let volume = blobs_u16();
    let size = [61, 47];
    let look_from = |eye, projection| look(eye, DVec3::new(-0.1, 0.0, 0.05), projection, size);
    let middles = [
        ("near", look_from(DVec3::new(0.3, 0.4, 0.7), perspective(0.9, size))),
        ("inside", look_from(DVec3::new(0.05, 0.1, 0.1), perspective(1.5, size))),
        ("parallel", look_from(DVec3::new(0.3, 0.4, 0.7), orthographic(1.3, size))),
    ];
    let phong = Settings { shading: Shading::Phong, ..plain(&volume) };
    let light = Light::Directional(Vec3::new(0.9, -0.3, 0.2));
    let lit = [
        ("headlight", phong.clone()),
        ("light", Settings { light, ..phong.clone() }),
        ("iso", Settings { mode: Mode::Isosurface { isovalue: 0.4 }, ..phong }),
    ];
    let rig = Rig::Stereo { eye_distance_m: 0.3, convergence_m: 0.8 };
    let mut cases = Vec::new();
    for (from, middle) in middles {
        for (eye, view) in ["left", "right"].into_iter().zip(rig.views(&middle)) {
            for (name, settings) in &lit {
                cases.push(Case { view, ..case(format!("{name} {from} {eye}"), settings.clone()) });
            }
        }
    }
    check("eyes of rigs", &volume, cases);
}

#[test]
fn clip_boxes_and_planes() {
    let volume = blobs_u16();
    let plane =
        |x: f64, y: f64, z: f64, offset_m: f64| Some(ClipPlane { normal: DVec3::new(x, y, z), offset_m });
    let (box_lo, box_hi) = (DVec3::new(0.2, 0.0, 0.31), DVec3::new(0.77, 0.6, 0.9));
    let clips = [
        ("box", Clip { box_lo, box_hi, plane: None }),
        ("plane", Clip { plane: plane(0.3, -1.0, 0.4, -0.05), ..Clip::default() }),
        ("box and plane", Clip { box_lo, box_hi, plane: plane(-2.0, 0.1, 0.4, 0.02) }),
        ("plane beyond", Clip { plane: plane(0.0, 1.0, 0.0, 7.0), ..Clip::default() }),
        ("flat box", Clip { box_lo: DVec3::splat(0.5), box_hi: DVec3::new(0.8, 0.8, 0.5), plane: None }),
        ("inverted box", Clip { box_lo: box_hi, box_hi: box_lo, plane: None }),
    ];
    let mut cases = Vec::new();
    let size = [53, 41];
    let inside =
        look(DVec3::new(-0.05, -0.1, 0.05), DVec3::new(0.5, 0.3, -0.4), perspective(1.4, size), size);
    for (clip_name, clip) in clips {
        for (name, settings) in few_settings(&volume) {
            let settings = Settings { clip, ..settings };
            cases.push(Case {
                view: inside,
                ..case(format!("{name} {clip_name} from inside"), settings.clone())
            });
            cases.push(case(format!("{name} {clip_name}"), settings));
        }
    }
    check("clip boxes and planes", &volume, cases);
}

#[test]
fn spacings_rotations_and_degenerate_sizes() {
    let lattices: [(&str, [usize; 3], DAffine3); 10] = [
        ("anisotropic", [20, 28, 33], spacing([2.0, 1.1, 0.7])),
        ("flat voxels", [30, 30, 9], spacing([0.5, 0.5, 4.0])),
        ("oblique", [27, 24, 30], oblique([1.0, 1.3, 0.8])),
        ("1 thick in x", [1, 24, 31], spacing([3.0, 1.0, 1.0])),
        ("1 thick in y", [24, 1, 31], spacing([1.0, 1.0, 1.0])),
        ("1 thick in z", [24, 31, 1], spacing([1.0, 1.0, 5.0])),
        ("a row", [40, 1, 1], spacing([1.0, 2.0, 2.0])),
        ("one voxel", [1, 1, 1], spacing([1.0; 3])),
        ("two voxels", [1, 2, 1], spacing([1.0; 3])),
        ("thin slices", [24, 256, 31], spacing([1.0, 5e-4, 1.0])),
    ];
    on_device(|gpu, renderer| {
        let mut report = Report::default();
        for (lattice, dims, patient_from_index) in lattices {
            let volume = blob_volume(dims, patient_from_index, VoxelType::U16);
            let plain = Settings { transfer: transfer(0.4), ..plain(&volume) };
            let settings = [
                ("2d phong", Settings { transfer: transfer_2d(), shading: Shading::Phong, ..plain.clone() }),
                ("ambient", Settings { shading: Shading::Ambient, ..plain.clone() }),
                (
                    "directional",
                    Settings { shading: Shading::Directional { directions: 4 }, ..plain.clone() },
                ),
                (
                    "tetrahedron iso",
                    Settings {
                        mode: Mode::Isosurface { isovalue: 0.4 },
                        shading: Shading::Phong,
                        gradient: GradientMethod::Tetrahedron,
                        ..plain.clone()
                    },
                ),
            ];
            for (name, settings) in few_settings(&volume).into_iter().chain(settings) {
                report.run(gpu, renderer, &volume, &case(format!("{name} {lattice}"), settings));
            }
        }
        report.finish("spacings, rotations and degenerate sizes");
    });
}

#[test]
fn phantoms() {
    on_device(|gpu, renderer| {
        let mut report = Report::default();
        for phantom in
            [Phantom::Sphere, Phantom::MarschnerLobb, Phantom::SheppLogan, Phantom::Ramp, Phantom::SolidBox]
        {
            let volume = phantom.cube(32).unwrap();
            // Flat faces, which shading rays must not start inside of.
            let ambient = Settings {
                mode: Mode::Isosurface { isovalue: 0.4 },
                shading: Shading::Ambient,
                ..plain(&volume)
            };
            for (name, settings) in few_settings(&volume).into_iter().chain([("iso ambient", ambient)]) {
                let format = TexelFormat::for_volume(&volume, StorageKind::lossless_for(&volume), gpu);
                let name = format!("{name} {phantom}");
                report.run(gpu, renderer, &volume, &Case { name, format, settings, view: outside() });
            }
        }
        report.finish("phantoms");
    });
}
