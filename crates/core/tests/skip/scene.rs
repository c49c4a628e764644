//! Random volumes, block sizes and settings, and a trilinear sampler that is as plain as can be.

use glam::{DAffine3, Vec3};
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::gradient_map::GradientDepth;
use wheatstone_core::scene::{GradientMethod, Mode, Placement, Settings};
use wheatstone_core::skip::BlockSize;
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::volume::{Encoding, Grid, StorageKind, StoredVoxels, Volume, Voxels, Window};

/// A volume with its stored numbers.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) volume: Volume,
    pub(crate) kind: StorageKind,
    pub(crate) encoding: Encoding,
    pub(crate) stored: Vec<f32>,
}

impl Scene {
    pub(crate) fn new(dims: [usize; 3], voxels: Voxels) -> Self {
        let volume = Volume::new(Grid::centred(dims, [1.0, 1.5, 0.8]).unwrap(), voxels).unwrap();
        let kind = StorageKind::lossless_for(&volume);
        let encoding = Encoding::new(&volume, kind);
        let stored = numbers(&encoding.encode(volume.voxels(), 0..volume.voxels().len()));
        Self { volume, kind, encoding, stored }
    }

    pub(crate) fn dims(&self) -> [usize; 3] {
        self.volume.grid().dims()
    }

    /// The normalised value at a texture position, as the casters compute it in f32.
    pub(crate) fn value_at(&self, window: Window, position: Vec3) -> f32 {
        let (scale, offset) = self.encoding.normalised_from_stored(window);
        (trilinear(self.dims(), &self.stored, position) * scale as f32 + offset as f32).clamp(0.0, 1.0)
    }

    /// The same normalised in f64.
    pub(crate) fn value_at_f64(&self, window: Window, position: Vec3) -> f64 {
        let (scale, offset) = self.encoding.normalised_from_stored(window);
        (f64::from(trilinear(self.dims(), &self.stored, position)) * scale + offset).clamp(0.0, 1.0)
    }

    pub(crate) fn parameters(&self, settings: &Settings) -> CastParameters {
        CastParameters::new(settings, &Placement::new(&self.volume, DAffine3::IDENTITY))
    }
}

pub(crate) fn numbers(stored: &StoredVoxels) -> Vec<f32> {
    match stored {
        StoredVoxels::U8(v) => v.iter().map(|&x| f32::from(x)).collect(),
        StoredVoxels::U16(v) => v.iter().map(|&x| f32::from(x)).collect(),
        StoredVoxels::F32(v) => v.clone(),
    }
}

/// Trilinear interpolation of voxels at a texture position, clamped to the volume.
pub(crate) fn trilinear(dims: [usize; 3], voxels: &[f32], position: Vec3) -> f32 {
    let centred = [0, 1, 2].map(|axis| position[axis] * dims[axis] as f32 - 0.5);
    let corner = |axis: usize, side: isize| {
        (centred[axis].floor() as isize + side).clamp(0, dims[axis] as isize - 1) as usize
    };
    let voxel = |x: isize, y: isize, z: isize| {
        voxels[corner(0, x) + dims[0] * (corner(1, y) + dims[1] * corner(2, z))]
    };
    let mix = |a: f32, b: f32, axis: usize| a + (b - a) * (centred[axis] - centred[axis].floor());
    let along_x = |y, z| mix(voxel(0, y, z), voxel(1, y, z), 0);
    let along_y = |z| mix(along_x(0, z), along_x(1, z), 1);
    mix(along_y(0), along_y(1), 2)
}

pub(crate) fn block_sizes() -> impl Strategy<Value = BlockSize> {
    let side = || BlockSize::SMALLEST..=BlockSize::LARGEST;
    prop_oneof![
        2 => (2_u32..6).prop_map(|side| BlockSize::cube(side).unwrap()),
        1 => (side(), side(), side()).prop_map(|(x, y, z)| BlockSize::new([x, y, z]).unwrap()),
    ]
}

/// Volumes of every storage kind: flat areas, few levels, noise; sides from one voxel.
pub(crate) fn scenes() -> impl Strategy<Value = Scene> {
    let side = || prop_oneof![1 => Just(1_usize), 4 => 2_usize..20];
    ((side(), side(), side()), 0..6, prop_oneof![Just(2_u32), Just(5), Just(1000)], 0.0..1.0_f64)
        .prop_flat_map(|((x, y, z), voxel_type, levels, flat)| {
            let level = prop_oneof![
                (100.0 * flat) as u32 => Just(0_u32),
                1 + (100.0 * (1.0 - flat)) as u32 => 0..levels,
            ];
            prop::collection::vec(level, x * y * z).prop_map(move |drawn| {
                let share = |level: u32| f64::from(level) / f64::from(levels - 1);
                let voxels = match voxel_type {
                    0 => Voxels::U8(drawn.iter().map(|&l| (share(l) * 255.0) as u8).collect()),
                    1 => Voxels::U16(drawn.iter().map(|&l| (share(l) * 65535.0) as u16).collect()),
                    2 => Voxels::I16(drawn.iter().map(|&l| (share(l) * 4000.0 - 1000.0) as i16).collect()),
                    3 => Voxels::F32(drawn.iter().map(|&l| share(l) as f32 * 0.1 - 0.03).collect()),
                    4 => Voxels::F32(drawn.iter().map(|&l| share(l) as f32 * 3e38).collect()),
                    _ => Voxels::F64(drawn.iter().map(|&l| 1e9 + share(l)).collect()),
                };
                Scene::new([x, y, z], voxels)
            })
        })
}

/// The whole range of a volume, or a part of it, or more.
pub(crate) fn windows(scene: &Scene) -> impl Strategy<Value = Window> + use<> {
    let full = scene.volume.full_window();
    let at = move |share: f64| full.denormalise(share);
    prop_oneof![
        Just(full),
        (-0.5..0.5_f64, 0.6..1.5_f64).prop_map(move |(lo, hi)| Window::new(at(lo), at(hi)).unwrap_or(full)),
    ]
}

/// Transfer functions with gaps, steps and spikes of one entry.
pub(crate) fn transfers() -> impl Strategy<Value = TransferFunction> {
    let part = || {
        let steps =
            prop::collection::vec((-0.1_f32..1.1, prop_oneof![Just(0.0_f32), Just(1.0), 0.0_f32..1.0]), 1..6);
        let spike = (0_u32..4096).prop_map(|entry| {
            let at = |e: f32| e / 4095.0;
            let middle = entry as f32;
            vec![(at(middle - 0.9), 0.0), (at(middle), 1.0), (at(middle + 0.9), 0.0)]
        });
        // A level of an 8-bit volume that is an entry of the table, too.
        let spike_on_level = (0_u32..16).prop_map(|level| {
            let at = level as f32 * 17.0 / 255.0;
            vec![(at + 1e-6, 0.0), (at + 1.0 / 4095.0, 1.0), (at + 2.0 / 4095.0, 0.0)]
        });
        prop_oneof![steps, spike, spike_on_level]
    };
    (part(), prop::option::of(part())).prop_map(|(value, gradient)| {
        let points = |mut points: Vec<(f32, f32)>| -> Vec<OpacityPoint> {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            points.into_iter().map(|(at, alpha)| OpacityPoint { at, alpha }).collect()
        };
        TransferFunction::new(vec![ColorPoint { at: 0.0, rgb: [1.0; 3] }], points(value))
            .unwrap()
            .with_gradient_opacity(gradient.map(points).unwrap_or_default())
            .unwrap()
    })
}

pub(crate) fn modes() -> impl Strategy<Value = Mode> {
    prop_oneof![
        4 => Just(Mode::Composite),
        1 => Just(Mode::Mip),
        1 => Just(Mode::MinIp),
        1 => Just(Mode::Mean),
        1 => Just(Mode::XRay),
        2 => (-0.1_f32..1.1).prop_map(|isovalue| Mode::Isosurface { isovalue }),
        1 => (0_u8..=255).prop_map(|level| Mode::Isosurface { isovalue: f32::from(level) / 255.0 }),
    ]
}

/// Positions in a block, texture space: anywhere, on its faces, at voxel centres.
pub(crate) fn share_of_block() -> impl Strategy<Value = f32> {
    prop_oneof![4 => 0.0_f32..1.0, 1 => Just(0.0), 1 => Just(1.0), 2 => (0_u8..8).prop_map(|i| f32::from(i) / 8.0)]
}

pub(crate) fn methods() -> impl Strategy<Value = GradientMethod> {
    prop::sample::select(vec![GradientMethod::CentralDifferences, GradientMethod::Tetrahedron])
}

pub(crate) fn depths() -> impl Strategy<Value = GradientDepth> {
    prop::sample::select(vec![GradientDepth::Bits8, GradientDepth::Bits16])
}
