//! Views, moved eyes, and true casts of small phantoms.

use glam::{DAffine3, DMat3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::Image;
use wheatstone_core::metrics::compare_where;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Placement, Settings, Shading};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{Frustum, Orbit, Projection, RayField, View};
use wheatstone_core::volume::Window;
use wheatstone_core::warp::{EmissionAbsorption, LayerThresholds};

/// Divisible by nothing that bands of rows are made of.
pub(crate) const SIZE: [u32; 2] = [149, 131];

/// A view of the volume that fills most of the picture.
pub(crate) fn front() -> View {
    let frustum = Frustum::from_fov(0.9, SIZE).unwrap();
    Orbit { azimuth_rad: 0.4, elevation_rad: 0.3, distance_m: 1.4 }
        .view(Projection::Perspective(frustum), SIZE)
}

/// The view of an eye moved and then turned in place, in its own axes.
pub(crate) fn moved(view: &View, by_m: DVec3, turn: DMat3) -> View {
    let world_from_view = view.view_from_world.inverse() * DAffine3::from_mat3_translation(turn, by_m);
    View { view_from_world: world_from_view.inverse(), ..*view }
}

/// Opaque from a value upwards, in colours that depend on the value and, by a fixed light, on the surface.
pub(crate) fn opaque_settings() -> Settings {
    let point = |at, rgb| ColorPoint { at, rgb };
    let colors = vec![point(0.0, [0.9, 0.6, 0.2]), point(0.6, [0.3, 0.7, 0.9]), point(1.0, [0.9, 0.9, 0.8])];
    let alphas = [(0.1, 0.0), (0.4, 1.0)].map(|(at, alpha)| OpacityPoint { at, alpha }).to_vec();
    let transfer = TransferFunction::new(colors, alphas).unwrap();
    let mut settings = Settings::new(Window::new(0.0, 255.0).unwrap(), transfer);
    settings.shading = Shading::Shadow;
    settings.sampling_factor = 4.0;
    settings
}

/// A caster of a phantom that is one metre long and lit by a fixed light: a picture of its own for every view.
pub(crate) fn caster_of(phantom: Phantom) -> impl Fn(&View) -> Image {
    let volume = phantom.cube(48).unwrap();
    let placement = Placement::new(&volume, DAffine3::from_scale(DVec3::splat(1.0 / 48.0)));
    let parameters = CastParameters::new(&opaque_settings(), &placement);
    let caster = Caster::new(&volume);
    move |view| caster.cast(&parameters, &Aids::default(), std::slice::from_ref(view)).remove(0).image
}

/// A flat, opaque rectangle that faces world +Z.
pub(crate) struct Plate {
    /// World z, metres.
    pub(crate) z_m: f64,
    /// World x from and to, metres; it is endless along y.
    pub(crate) x_m: [f64; 2],
    /// By world x and y in metres.
    pub(crate) rgb: fn(f64, f64) -> [f32; 3],
}

/// What a view sees of plates, one ray through each pixel's centre.
pub(crate) fn painted(view: &View, plates: &[Plate]) -> Image {
    let [width, height] = view.size;
    let rays = RayField::new(view, DAffine3::IDENTITY);
    let mut image = Image::transparent(width, height);
    for (index, (color, depth_m)) in image.color.iter_mut().zip(&mut image.depth_m).enumerate() {
        let (x, y) = (index as u32 % width, index as u32 / width);
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        for plate in plates {
            let at_m = (plate.z_m - origin.z) / direction.z;
            let hit = origin + at_m * direction;
            if at_m > 0.0 && at_m < f64::from(*depth_m) && (plate.x_m[0]..plate.x_m[1]).contains(&hit.x) {
                let [r, g, b] = (plate.rgb)(hit.x, hit.y);
                (*color, *depth_m) = ([r, g, b, 1.0], at_m as f32);
            }
        }
    }
    image
}

/// Smooth waves of colour.
pub(crate) fn waves(x: f64, y: f64) -> [f32; 3] {
    [(20.0 * x).sin(), (17.0 * y).sin(), (12.0 * (x + y)).cos()].map(|wave| (0.5 + 0.4 * wave) as f32)
}

/// Dissimilarity of two pictures over black.
pub(crate) fn dssim(first: &Image, second: &Image) -> f64 {
    dssim_where(first, second, &vec![true; first.color.len()])
}

/// Dissimilarity of two pictures over black, in the windows that touch marked pixels.
pub(crate) fn dssim_where(first: &Image, second: &Image, marked: &[bool]) -> f64 {
    let [first, second] = [first, second].map(|image| image.over_background([0.0; 3]));
    compare_where(&first, &second, marked).unwrap().dssim()
}

/// Largest difference of any channel.
pub(crate) fn largest_difference(first: &Image, second: &Image) -> f32 {
    let channels = |image: &Image| image.color.iter().flatten().copied().collect::<Vec<_>>();
    channels(first).iter().zip(channels(second)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Faint and unlit, in colours that depend on the value.
pub(crate) fn soft_settings() -> Settings {
    let alphas =
        [(0.05, 0.0), (0.3, 0.03), (1.0, 0.1)].map(|(at, alpha)| OpacityPoint { at, alpha }).to_vec();
    let transfer = TransferFunction::new(opaque_settings().transfer.color_points().to_vec(), alphas).unwrap();
    Settings { shading: Shading::None, transfer, early_termination: None, ..opaque_settings() }
}

/// Small phantoms, each translucent and opaque.
pub(crate) fn translucent_and_opaque() -> Vec<(Phantom, Settings)> {
    let of = |phantom| [soft_settings(), opaque_settings()].map(|settings| (phantom, settings));
    [Phantom::SheppLogan, Phantom::Present].into_iter().flat_map(of).collect()
}

/// A phantom, one metre long, with what its casts need.
pub(crate) struct Scene {
    pub(crate) caster: Caster,
    pub(crate) parameters: CastParameters,
}

impl Scene {
    pub(crate) fn new(phantom: Phantom, settings: &Settings) -> Self {
        let volume = phantom.cube(48).unwrap();
        let placement = Placement::new(&volume, DAffine3::from_scale(DVec3::splat(1.0 / 48.0)));
        Self { caster: Caster::new(&volume), parameters: CastParameters::new(settings, &placement) }
    }

    pub(crate) fn cast(&self, view: &View) -> Image {
        self.caster.cast(&self.parameters, &Aids::default(), std::slice::from_ref(view)).remove(0).image
    }

    pub(crate) fn layers(&self, view: &View, thresholds: &LayerThresholds) -> (Cast, EmissionAbsorption) {
        self.caster.cast_emission_absorption(&self.parameters, &Aids::default(), view, thresholds).unwrap()
    }
}
