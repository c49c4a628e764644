//! Volumes, settings and views that the tests share, and both casters behind one call.

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{
    AnatomicalDirection, Frustum, OrthographicBox, Projection, View, world_from_patient,
};
use wheatstone_core::volume::{Grid, StorageKind, Volume, VoxelType, Voxels};
use wheatstone_render::{Gpu, GpuError, GpuVolume, Renderer, Sources, TexelFormat};

/// The precision that a texel format holds.
pub(crate) fn storage_kind(format: TexelFormat) -> StorageKind {
    match format {
        TexelFormat::R8Unorm | TexelFormat::R16FloatOf8Bit | TexelFormat::Rgba8UnormQuads => StorageKind::U8,
        TexelFormat::R16Unorm | TexelFormat::R16FloatOf16Bit => StorageKind::U16,
        TexelFormat::R32Float => StorageKind::F32,
    }
}

/// A smooth scene of soft balls of different density in a faint haze, from 0 to 1, as a function of texture coordinates.
fn blobs(p: DVec3) -> f64 {
    let ball = |x: f64, y: f64, z: f64, width: f64| {
        (-(p - DVec3::new(x, y, z)).length_squared() / (width * width)).exp()
    };
    let balls = ball(0.35, 0.4, 0.3, 0.17)
        .max(0.7 * ball(0.7, 0.3, 0.55, 0.22))
        .max(0.45 * ball(0.5, 0.75, 0.7, 0.2));
    let haze = 0.08 * (1.0 + (9.0 * p.x).sin() * (7.0 * p.y).cos() * (8.0 * p.z).sin());
    (balls + haze).clamp(0.0, 1.0)
}

/// The scene at any size, with voxels of a type over most of its range.
pub(crate) fn blob_volume(dims: [usize; 3], patient_from_index: DAffine3, voxel_type: VoxelType) -> Volume {
    let [nx, ny, nz] = dims;
    let at = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
    let values: Vec<f64> = (0..nx * ny * nz)
        .map(|i| blobs(DVec3::new(at(i % nx, nx), at(i / nx % ny, ny), at(i / (nx * ny), nz))))
        .collect();
    let scaled = |low: f64, high: f64| values.iter().map(move |v| low + v * (high - low));
    let voxels = match voxel_type {
        VoxelType::U8 => Voxels::U8(scaled(3.0, 250.0).map(|v| v as u8).collect()),
        VoxelType::U16 => Voxels::U16(scaled(100.0, 40_000.0).map(|v| v as u16).collect()),
        VoxelType::I16 => Voxels::I16(scaled(-1024.0, 3071.0).map(|v| v as i16).collect()),
        VoxelType::F32 => Voxels::F32(scaled(-0.5, 12.0).map(|v| v as f32).collect()),
        other => panic!("no blobs of {other}"),
    };
    Volume::new(Grid::new(dims, patient_from_index).unwrap(), voxels).unwrap()
}

pub(crate) fn spacing(spacing_mm: [f64; 3]) -> DAffine3 {
    DAffine3::from_scale(DVec3::from(spacing_mm))
}

/// A left-handed lattice at an angle to the patient.
pub(crate) fn oblique(spacing_mm: [f64; 3]) -> DAffine3 {
    let turn = DMat3::from_quat(DQuat::from_euler(EulerRot::XYZ, 0.3, -0.7, 1.9));
    let [x, y, z] = spacing_mm;
    DAffine3::from_mat3_translation(
        turn * DMat3::from_diagonal(DVec3::new(x, -y, z)),
        DVec3::new(40.0, -7.0, 9.0),
    )
}

/// Blue to yellow, with opacity from a tenth of the range upwards.
pub(crate) fn transfer(most_alpha: f32) -> TransferFunction {
    let color = [(0.0, [0.1, 0.2, 0.6]), (0.5, [0.8, 0.3, 0.3]), (1.0, [1.0, 0.9, 0.5])];
    let opacity = [(0.15, 0.0), (0.6, 0.5 * most_alpha), (1.0, most_alpha)];
    TransferFunction::new(
        color.map(|(at, rgb)| ColorPoint { at, rgb }).to_vec(),
        opacity.map(|(at, alpha)| OpacityPoint { at, alpha }).to_vec(),
    )
    .unwrap()
}

/// The same, but clear where the value hardly changes.
pub(crate) fn transfer_2d() -> TransferFunction {
    let gradient = [(0.005, 0.0), (0.06, 1.0)].map(|(at, alpha)| OpacityPoint { at, alpha });
    transfer(0.6).with_gradient_opacity(gradient.to_vec()).unwrap()
}

/// The patient upright, the longest side one metre.
pub(crate) fn placement(volume: &Volume) -> Placement {
    Placement::new(volume, world_from_patient(volume.grid(), AnatomicalDirection::Superior))
}

pub(crate) fn perspective(fov_rad: f64, size: [u32; 2]) -> Projection {
    Projection::Perspective(Frustum::from_fov(fov_rad, size).unwrap())
}

pub(crate) fn off_axis(fov_rad: f64, size: [u32; 2], tangent: f64) -> Projection {
    Projection::Perspective(Frustum::from_fov(fov_rad, size).unwrap().sheared(tangent))
}

pub(crate) fn orthographic(height_m: f64, size: [u32; 2]) -> Projection {
    Projection::Orthographic(OrthographicBox::from_height(height_m, size).unwrap())
}

/// A view from an eye towards a point.
pub(crate) fn look(eye: DVec3, at: DVec3, projection: Projection, size: [u32; 2]) -> View {
    let back = (eye - at).normalize_or_zero();
    let right = DVec3::Y.cross(back).normalize_or_zero();
    let world_from_view =
        DAffine3::from_mat3_translation(DMat3::from_cols(right, back.cross(right), back), eye);
    View { view_from_world: world_from_view.inverse(), projection, size, shaded_from: None }
}

/// A picture of an odd size that shows the whole volume at an angle.
pub(crate) fn outside() -> View {
    let size = [61, 47];
    look(DVec3::new(0.9, 0.6, 1.1), DVec3::ZERO, perspective(0.9, size), size)
}

/// The picture of the reference at the precision that a texel format holds.
pub(crate) fn cast_on_cpu(
    volume: &Volume,
    format: TexelFormat,
    parameters: &CastParameters,
    views: &[View],
) -> Vec<Cast> {
    Caster::with_storage(volume, storage_kind(format)).cast_exactly(parameters, &Aids::default(), views)
}

pub(crate) fn cast_on_gpu(
    gpu: &Gpu,
    renderer: &mut Renderer,
    volume: &Volume,
    format: TexelFormat,
    settings: &Settings,
    views: &[View],
) -> Result<Vec<Cast>, GpuError> {
    let uploaded = GpuVolume::upload_as(gpu, volume, format, &mut |_, _| {})?;
    let prepared = renderer.prepare(
        gpu,
        &Sources::volume(&uploaded),
        CastParameters::new(settings, &placement(volume)),
    )?;
    renderer.render_to_host(gpu, &prepared, views)
}

/// Largest difference of any channel, alpha included.
pub(crate) fn largest_difference(a: &Cast, b: &Cast) -> f64 {
    let channels = |cast: &Cast| cast.image.color.iter().flatten().copied().collect::<Vec<f32>>();
    channels(a).iter().zip(channels(b)).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
}
