//! Short ways to scenes, views and rays. Rays are worked out here from the definitions in `ARCHITECTURE.md`, not with the
//! crate's own code, so that tests do not repeat its mistakes.

use glam::{DAffine3, DMat3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::{Image, RgbImage};
use wheatstone_core::metrics::{Comparison, compare};
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{Frustum, OrthographicBox, Projection, View};
use wheatstone_core::volume::{Grid, Volume, Voxels, Window};

/// Scale of the test world: patient axes are world axes, and 100 mm are a metre.
pub(crate) const METRES_PER_MM: f64 = 0.01;

pub(crate) fn world_from_patient() -> DAffine3 {
    DAffine3::from_scale(DVec3::splat(METRES_PER_MM))
}

/// A picture of a volume in the test world.
pub(crate) fn cast(volume: &Volume, settings: &Settings, view: &View) -> Cast {
    cast_at(volume, world_from_patient(), settings, view)
}

/// A picture of a volume placed by any map.
pub(crate) fn cast_at(
    volume: &Volume,
    world_from_patient: DAffine3,
    settings: &Settings,
    view: &View,
) -> Cast {
    let parameters = CastParameters::new(settings, &Placement::new(volume, world_from_patient));
    Caster::new(volume).cast_exactly(&parameters, &Aids::default(), std::slice::from_ref(view)).remove(0)
}

/// A volume of values from 0 to 1 by a function of the position in voxels (centres at ½).
pub(crate) fn volume_of(dims: [usize; 3], spacing_mm: [f64; 3], value: impl Fn(DVec3) -> f64) -> Volume {
    let [nx, ny, nz] = dims;
    let centre = |i: usize| i as f64 + 0.5;
    let voxels = (0..nx * ny * nz)
        .map(|i| value(DVec3::new(centre(i % nx), centre(i / nx % ny), centre(i / (nx * ny)))) as f32)
        .collect();
    Volume::new(Grid::centred(dims, spacing_mm).unwrap(), Voxels::F32(voxels)).unwrap()
}

/// The window of [`volume_of`].
pub(crate) fn unit_window() -> Window {
    Window::new(0.0, 1.0).unwrap()
}

/// The window of 8-bit phantoms.
pub(crate) fn byte_window() -> Window {
    Window::new(0.0, 255.0).unwrap()
}

/// One colour and one opacity everywhere.
pub(crate) fn constant_transfer(rgb: [f32; 3], alpha: f32) -> TransferFunction {
    TransferFunction::new(vec![ColorPoint { at: 0.0, rgb }], vec![OpacityPoint { at: 0.0, alpha }]).unwrap()
}

/// White, with opacities at given values.
pub(crate) fn white_transfer(opacity: &[(f32, f32)]) -> TransferFunction {
    let points = opacity.iter().map(|&(at, alpha)| OpacityPoint { at, alpha }).collect();
    TransferFunction::new(vec![ColorPoint { at: 0.0, rgb: [1.0; 3] }], points).unwrap()
}

/// Grey levels equal to the value, opaque everywhere.
pub(crate) fn grey_transfer() -> TransferFunction {
    let grey = |at: f32| ColorPoint { at, rgb: [at; 3] };
    TransferFunction::new(vec![grey(0.0), grey(1.0)], vec![OpacityPoint { at: 0.0, alpha: 1.0 }]).unwrap()
}

/// Unlit composite without early termination.
pub(crate) fn exact_settings(window: Window, transfer: TransferFunction) -> Settings {
    Settings { early_termination: None, ..Settings::new(window, transfer) }
}

pub(crate) fn perspective(fov_rad: f64, size: [u32; 2]) -> Projection {
    Projection::Perspective(Frustum::from_fov(fov_rad, size).unwrap())
}

pub(crate) fn orthographic(height_m: f64, size: [u32; 2]) -> Projection {
    Projection::Orthographic(OrthographicBox::from_height(height_m, size).unwrap())
}

/// A view from an eye towards a point; `up` need not be perpendicular.
pub(crate) fn look(eye: DVec3, at: DVec3, up: DVec3, projection: Projection, size: [u32; 2]) -> View {
    let back = (eye - at).normalize_or_zero();
    let right = up.cross(back).normalize_or_zero();
    let world_from_view =
        DAffine3::from_mat3_translation(DMat3::from_cols(right, back.cross(right), back), eye);
    View { view_from_world: world_from_view.inverse(), projection, size, shaded_from: None }
}

/// Origin and direction per metre of depth of a pixel's ray, world space.
pub(crate) fn world_ray(view: &View, x: u32, y: u32) -> (DVec3, DVec3) {
    let across = (f64::from(x) + 0.5) / f64::from(view.size[0]);
    let down = (f64::from(y) + 0.5) / f64::from(view.size[1]);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let world_from_view = view.view_from_world.inverse();
    let (origin, direction) = match view.projection {
        Projection::Perspective(f) => {
            (DVec3::ZERO, DVec3::new(mix(f.left, f.right, across), mix(f.up, f.down, down), -1.0))
        }
        Projection::Orthographic(o) => {
            (DVec3::new(mix(o.left_m, o.right_m, across), mix(o.up_m, o.down_m, down), 0.0), DVec3::NEG_Z)
        }
        Projection::Mcop(_) => panic!("these views are those of eyes"),
    };
    (world_from_view.transform_point3(origin), world_from_view.transform_vector3(direction))
}

/// Points with `normal · p ≥ offset`.
#[derive(Clone, Copy)]
pub(crate) struct HalfSpace {
    pub(crate) normal: DVec3,
    pub(crate) offset: f64,
}

/// The six half-spaces of a box.
pub(crate) fn box_sides(lo: DVec3, hi: DVec3) -> Vec<HalfSpace> {
    [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .flat_map(|axis| {
            [
                HalfSpace { normal: axis, offset: axis.dot(lo) },
                HalfSpace { normal: -axis, offset: -axis.dot(hi) },
            ]
        })
        .collect()
}

/// The box of a volume in the test world, metres.
pub(crate) fn volume_box_m(volume: &Volume) -> (DVec3, DVec3) {
    let half = 0.5 * METRES_PER_MM * volume.grid().size_mm();
    (-half, half)
}

/// Depths between which a ray is in front of the eye and within all half-spaces.
pub(crate) fn depths_within(
    view: &View,
    (origin, direction): (DVec3, DVec3),
    parts: &[HalfSpace],
) -> (f64, f64) {
    let mut interval = match view.projection {
        Projection::Perspective(f) => (f.near_m, f.far_m),
        Projection::Orthographic(o) => (o.near_m, o.far_m),
        Projection::Mcop(m) => (m.near_m, m.far_m),
    };
    for part in parts {
        let height = part.normal.dot(origin) - part.offset;
        let climb = part.normal.dot(direction);
        if climb > 0.0 {
            interval.0 = interval.0.max(-height / climb);
        } else if climb < 0.0 {
            interval.1 = interval.1.min(-height / climb);
        } else if height < 0.0 {
            return (0.0, 0.0);
        }
    }
    if interval.0 < interval.1 { interval } else { (0.0, 0.0) }
}

/// Every pixel of a view.
pub(crate) fn pixels(view: &View) -> impl Iterator<Item = (u32, u32)> + use<> {
    let [width, height] = view.size;
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

pub(crate) fn color_at(image: &Image, x: u32, y: u32) -> [f32; 4] {
    image.color[(y * image.width + x) as usize]
}

pub(crate) fn depth_at_m(image: &Image, x: u32, y: u32) -> f64 {
    f64::from(image.depth_m[(y * image.width + x) as usize])
}

pub(crate) fn over_black(cast: &Cast) -> RgbImage {
    cast.image.over_background([0.0; 3])
}

pub(crate) fn difference(a: &Cast, b: &Cast) -> Comparison {
    compare(&over_black(a), &over_black(b)).unwrap()
}

/// Largest difference of any channel, alpha included.
pub(crate) fn largest_difference(a: &Cast, b: &Cast) -> f64 {
    let channels = |cast: &Cast| cast.image.color.iter().flatten().copied().collect::<Vec<f32>>();
    channels(a).iter().zip(channels(b)).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
}
