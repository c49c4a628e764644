//! Every form of a pair against the others and against the sequential order of compositing, on random volumes and rigs.

use crate::device::on_device;
use crate::pairs::render_pair;
use crate::scene::*;
use glam::{DAffine3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Aids, Cast, Caster, RayEnd, Reprojection, Splat};
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::view::{Projection, Rig, View};
use wheatstone_core::volume::{Grid, Volume, Voxels};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{
    Form, Gpu, GpuVolume, LayerFormat, Leap, PairError, PairMethod, Quality, Renderer, Sources, TexelFormat,
};

/// Forms that do not round segments to 8 bits.
const FORMS: [Form; 3] = [Form::Strips, Form::Tiles, Form::Layers(LayerFormat::Rgba16Float)];

/// Which columns segments go to, by quality.
const SPLATS: [(Quality, Splat); 2] = [(Quality::Nearest, Splat::Nearest), (Quality::Fast, Splat::Linear)];

/// Every form with every splat.
fn methods() -> Vec<PairMethod> {
    FORMS.iter().flat_map(|&form| SPLATS.map(|(quality, _)| PairMethod { form, quality })).collect()
}

/// Layers of the cases: one, few, those of the papers, some that no strip, square or power of two divides, and more than a
/// strip is wide.
const LAYERS: [u32; 16] = [1, 2, 1, 3, 5, 12, 20, 33, 34, 47, 64, 65, 90, 128, 150, 200];

/// Mean difference of channels: half floats, and a sample here and there on the other side of a slab's bound.
const MEAN_DIFFERENCE: f64 = 2e-4;

/// Difference of a channel that counts as none: two levels of an 8-bit picture.
const SAME: f64 = 2.0 / 255.0;

/// Share of channels that may differ by more.
const SHARE_OF_OTHERS: f64 = 0.002;

/// Share of pixels whose first hit may be in another slab: a sum of several segments, strips or tiles may be one that none of
/// them is.
const SHARE_OF_OTHER_HITS: f64 = 0.03;

/// Numbers that look random, the same on every run (`SplitMix64`).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn whole(&mut self, low: u32, high: u32) -> u32 {
        self.between(low.into(), f64::from(high) + 1.0) as u32
    }

    fn vector(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::from([(); 3].map(|()| self.between(low, high)))
    }
}

/// A volume, how it is shown and a pair that sees it.
struct Case {
    volume: Volume,
    parameters: CastParameters,
    leaps: bool,
    epipolar: Epipolar,
}

impl Case {
    /// A random case of so many layers; its number tells what is on and what is off.
    fn new(number: u64, layers: u32, mode: Mode) -> Self {
        let is = |bit: u32| number >> bit & 1 == 1;
        let mut random = Random(300 + number);
        let volume = noise(&mut random);
        let mut settings = Settings::new(volume.full_window(), transfer(random.between(0.2, 0.95) as f32));
        settings.mode = mode;
        settings.sampling_factor = random.between(1.0, 3.0) as f32;
        settings.preintegrated = random.bits() & 1 == 1;
        settings.early_termination = is(1).then_some(0.99);
        if is(2) {
            settings.clip.box_lo = random.vector(0.0, 0.3);
            settings.clip.box_hi = random.vector(0.7, 1.0);
        }
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let epipolar = pair(&mut random, &parameters, layers, is(0));
        let depths_m = epipolar.depths_m(&parameters.visible_corners_world()).unwrap();
        assert_eq!(epipolar.slabs().between(depths_m.start, depths_m.end).layers(), layers);
        Self { volume, parameters, leaps: is(3), epipolar }
    }

    /// Both eyes by each form, cast twice.
    fn pairs(&self, gpu: &Gpu, renderer: &mut Renderer, methods: &[PairMethod]) -> Vec<[[Cast; 2]; 2]> {
        let uploaded = GpuVolume::upload_as(gpu, &self.volume, FORMAT, &mut |_, _| {}).unwrap();
        let kernels = SkipKernels::new(gpu).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, BlockSize::cube(3).unwrap()).unwrap();
        let map = builder.map(gpu, &self.parameters, Structure::Anisotropic).unwrap();
        let leap = if self.leaps { Leap::EmptyBlocks(&map) } else { Leap::Nothing };
        let sources = Sources { leap, ..Sources::volume(&uploaded) };
        let prepared = renderer.prepare(gpu, &sources, self.parameters.clone()).unwrap();
        let pair =
            |method| [(); 2].map(|()| render_pair(gpu, renderer, &prepared, &self.epipolar, method).unwrap());
        methods.iter().copied().map(pair).collect()
    }

    /// Both eyes in the sequential order.
    fn truth(&self, splat: Splat) -> [Cast; 2] {
        let reprojection = Reprojection { splat, ray_end: RayEnd::Reference };
        Caster::with_storage(&self.volume, storage_kind(FORMAT))
            .cast_pair(&self.parameters, &Aids::default(), &self.epipolar, reprojection)
            .unwrap()
    }
}

/// What both casters hold exactly.
const FORMAT: TexelFormat = TexelFormat::R16FloatOf8Bit;

/// Soft lumps of random size and place, one in the middle.
fn noise(random: &mut Random) -> Volume {
    let dims = [(); 3].map(|()| random.whole(9, 24) as usize);
    let mut lumps = vec![(DVec3::splat(0.5), 0.2, 0.7)];
    lumps.resize_with(6, || (random.vector(0.0, 1.0), random.between(0.1, 0.35), random.between(0.3, 1.0)));
    let value = |p: DVec3| {
        lumps
            .iter()
            .map(|&(at, width, height)| height * (-(p - at).length_squared() / (width * width)).exp())
            .fold(0.0, f64::max)
    };
    let [nx, ny, nz] = dims;
    let voxels = (0..nx * ny * nz)
        .map(|i| {
            let index = DVec3::new((i % nx) as f64, (i / nx % ny) as f64, (i / (nx * ny)) as f64);
            let position = (index + 0.5) / DVec3::from(dims.map(|side| side as f64));
            (255.0 * value(position) + random.between(-6.0, 6.0)).clamp(0.0, 255.0) as u8
        })
        .collect();
    let spacing = DAffine3::from_scale(random.vector(0.8, 1.25));
    Volume::new(Grid::new(dims, spacing).unwrap(), Voxels::U8(voxels)).unwrap()
}

/// Eyes before the volume, as far apart as makes so many layers; either picture may cut the volume off at the left or at the
/// right.
fn pair(random: &mut Random, parameters: &CastParameters, layers: u32, is_swapped: bool) -> Epipolar {
    let size = [random.whole(20, 77) + layers, random.whole(5, 13)];
    let eye = DVec3::new(random.between(-0.6, 0.6), random.between(-0.4, 0.4), random.between(1.1, 1.6));
    let middle = look(
        eye,
        random.vector(-0.05, 0.05),
        perspective(random.between(0.5, 1.1) * f64::from(size[1]) / f64::from(size[0]), size),
        size,
    );
    // Both see the middle of the volume in the middle, but for a part of the picture.
    let convergence_m = -middle.view_from_world.translation.z;
    let pair = |eye_distance_m, shear| {
        let rig = Rig::Stereo { eye_distance_m, convergence_m };
        let [left, right]: [View; 2] = rig.views(&middle).try_into().unwrap();
        let [reference, mut derived] = if is_swapped { [right, left] } else { [left, right] };
        let Projection::Perspective(frustum) = derived.projection else { unreachable!() };
        derived.projection = Projection::Perspective(frustum.sheared(shear));
        Epipolar::new(&reference, &derived).unwrap()
    };
    let of_one_metre = pair(1.0, 0.0);
    let depths_m = of_one_metre.depths_m(&parameters.visible_corners_world()).unwrap();
    let columns_per_metre = of_one_metre.pixel_range(depths_m.start, depths_m.end);
    let shear = random.between(-0.3, 0.3) * f64::from(size[0]) / of_one_metre.k();
    pair((f64::from(layers) - 0.999) / columns_per_metre, shear)
}

/// Mean difference of channels, and the share of channels that differ by more than a limit.
fn difference(a: &Cast, b: &Cast, limit: f64) -> (f64, f64) {
    let channels = |cast: &Cast| cast.image.color.iter().flatten().copied().collect::<Vec<f32>>();
    let differences: Vec<f64> =
        channels(a).iter().zip(channels(b)).map(|(a, b)| f64::from((a - b).abs())).collect();
    let count = differences.len() as f64;
    let others = differences.iter().filter(|&&d| d > limit || d.is_nan()).count();
    (differences.iter().sum::<f64>() / count, others as f64 / count)
}

/// Share of pixels that are hit in one picture only, or at depths whose columns are further apart than some.
fn share_of_other_hits(a: &Cast, b: &Cast, k: f64, columns: f64) -> f64 {
    let depths_m = a.image.depth_m.iter().zip(&b.image.depth_m).map(|(&a, &b)| [f64::from(a), f64::from(b)]);
    let is_other = |[a, b]: &[f64; 2]| a.is_finite() != b.is_finite() || (k / a - k / b).abs() > columns;
    depths_m.filter(is_other).count() as f64 / a.image.depth_m.len() as f64
}

fn mean_alpha(cast: &Cast) -> f64 {
    cast.image.color.iter().map(|color| f64::from(color[3])).sum::<f64>() / cast.image.color.len() as f64
}

/// Holds every form to the sequential order and to itself, for cases by number and layers.
fn check(cases: impl Iterator<Item = (u64, u32)>, mode: Mode) {
    on_device(|gpu, renderer| {
        let mut failures = Vec::new();
        for (number, layers) in cases {
            let case = Case::new(number, layers, mode);
            // X-rays are not shared by columns.
            let truths =
                SPLATS.map(|(_, splat)| case.truth(if mode == Mode::XRay { Splat::Nearest } else { splat }));
            assert!(mean_alpha(&truths[0][1]) > 0.02, "case {number} is nearly empty");
            // Truth ends each derived pixel at a sample, layers at a slab, strips and tiles not at all.
            let behind_end = 1.0 - f64::from(case.parameters.termination_alpha);
            let methods = methods();
            let made = case.pairs(gpu, renderer, &methods);
            for (PairMethod { form, quality }, [pair, again]) in methods.iter().zip(made) {
                let truth = &truths[SPLATS.iter().position(|(of, _)| of == quality).unwrap()];
                for (eye, [pair, again, truth]) in
                    [0, 1].map(|eye| [&pair[eye], &again[eye], &truth[eye]]).into_iter().enumerate()
                {
                    let (mean, others) = difference(pair, truth, SAME + behind_end);
                    let columns = if *quality == Quality::Nearest { 1.0 } else { 2.0 };
                    let hits = share_of_other_hits(pair, truth, case.epipolar.k(), columns);
                    if mean > MEAN_DIFFERENCE + 0.1 * behind_end
                        || others > SHARE_OF_OTHERS
                        || hits > SHARE_OF_OTHER_HITS
                    {
                        failures.push(format!(
                            "{number} {form:?} {quality:?} of {layers} layers, eye {eye}: mean {mean}, others {others}, hits {hits}"
                        ));
                    }
                    assert_eq!(largest_difference(pair, again), 0.0, "{number} {form:?}");
                    assert_eq!(pair.image.depth_m, again.image.depth_m, "{number} {form:?}");
                }
            }
        }
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    });
}

#[test]
fn cases_are_of_every_kind() {
    let kinds = (0..).zip(LAYERS).map(|(number, layers)| {
        let case = Case::new(number, layers, Mode::Composite);
        let corners = case.parameters.visible_corners_world();
        let [width, _] = case.epipolar.reference().size;
        let columns = case.epipolar.columns_of(&corners, &(-4_000..4_000));
        let depths_m = case.epipolar.depths_m(&corners).unwrap();
        let slabs = case.epipolar.slabs().between(depths_m.start, depths_m.end);
        let cast = case.epipolar.columns_of(&corners, &slabs.cast_columns(width));
        [
            ("cut at the left", columns.start < 0),
            ("cut at the right", columns.end > width as i32),
            ("rays beyond the left edge", cast.start < 0),
            ("rays beyond the right edge", cast.end > width as i32),
            ("shifts to both sides", slabs.furthest < 0 && slabs.nearest > 0),
            ("shifts to one side", slabs.furthest > 0 || slabs.nearest < 0),
            ("mirrored", case.epipolar.is_mirrored()),
            ("layers shared by rays", cast.len() > 2 * layers as usize),
        ]
    });
    let found = kinds.reduce(|a, b| std::array::from_fn(|i| (a[i].0, a[i].1 || b[i].1))).unwrap();
    assert!(found.iter().all(|(_, is_found)| *is_found), "{found:?}");
}

#[test]
fn every_form_is_the_sequential_order_and_the_same_bits_twice() {
    check((0..).zip(LAYERS), Mode::Composite);
}

#[test]
fn x_rays_add_up_in_every_form() {
    check((20..).zip([1, 4, 33, 65, 128]), Mode::XRay);
}

/// Levels of 1/255 that 8-bit layers may be off per layer.
const LEVELS_PER_LAYER: f64 = 0.5;

#[test]
fn layers_of_8_bits_round_each_segment() {
    on_device(|gpu, renderer| {
        let layers = 12;
        let case = Case::new(5, layers, Mode::Composite);
        let methods = [LayerFormat::Rgba8Unorm, LayerFormat::Rgba16Float]
            .map(|format| PairMethod { form: Form::Layers(format), ..PairMethod::default() });
        let [eight, half] = case.pairs(gpu, renderer, &methods).try_into().unwrap();
        assert_eq!(largest_difference(&eight[0][0], &half[0][0]), 0.0);
        let difference = largest_difference(&eight[0][1], &half[0][1]);
        let most = LEVELS_PER_LAYER * f64::from(layers) / 255.0;
        assert!((1e-4..most).contains(&difference), "{difference}");
    });
}

#[test]
fn more_layers_than_the_device_holds_are_said() {
    on_device(|gpu, renderer| {
        let case = Case::new(0, 3_000, Mode::Composite);
        let uploaded = GpuVolume::upload_as(gpu, &case.volume, FORMAT, &mut |_, _| {}).unwrap();
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), case.parameters.clone()).unwrap();
        let method = PairMethod { form: Form::Layers(LayerFormat::Rgba8Unorm), ..PairMethod::default() };
        let refused = render_pair(gpu, renderer, &prepared, &case.epipolar, method);
        assert!(matches!(refused, Err(PairError::Layers { layers: 3_000.., .. })));
    });
}
