//! Small displays and volumes for them.

use glam::{DAffine3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::lightfield::ProjectorArray;
use wheatstone_core::lightfield::projectors::{Description, ImageRect, Packing, Projector, VirtualViewer};
use wheatstone_core::reference::Caster;
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::volume::{Volume, Window};

/// A display of 0.2 × 0.15 m: so many projectors 0.5 m behind it, neighbours a beam apart, of which a quarter at each side is seen
/// in mirrors.
pub(crate) fn display(count: u32, beam_angle_deg: f64, image_size_px: [u32; 2]) -> ProjectorArray {
    let screen_size_m = [0.2, 0.15];
    let pitch_m = 2.0 * 0.5 * (0.5 * beam_angle_deg.to_radians()).tan();
    let in_mirror = count / 4;
    let projectors = (0..count).map(|id| {
        let x_m = (f64::from(id) - 0.5 * f64::from(count - 1)) * pitch_m;
        let straight = ImageRect { left_m: -0.1, right_m: 0.1, down_m: -0.075, up_m: 0.075 };
        let is_straight = (in_mirror..count - in_mirror).contains(&id);
        let reversed = ImageRect { left_m: 0.1, right_m: -0.1, ..straight };
        let image = if is_straight { straight } else { reversed };
        Projector { id, emitter_m: [x_m, 0.0, -0.5], image }
    });
    ProjectorArray::new(Description {
        wheatstone_projector_array: 1,
        screen_size_m,
        pixel_size_m: screen_size_m[0] / f64::from(image_size_px[0]),
        beam_angle_deg,
        viewer: VirtualViewer { height_m: 0.03, distance_m: 0.6 },
        image_size_px,
        projectors: projectors.collect(),
        packing: Packing { frame_size_px: [4 * image_size_px[0], 3 * image_size_px[1] + 8], header_rows: 8 },
    })
    .unwrap()
}

/// From patient to world space: the longest side of a volume as long as given, its middle in the middle of the screen.
pub(crate) fn world_from_patient(volume: &Volume, longest_side_m: f64) -> DAffine3 {
    let grid = volume.grid();
    let middle_mm = grid.patient_from_texture().transform_point3(DVec3::splat(0.5));
    DAffine3::from_scale(DVec3::splat(longest_side_m / grid.size_mm().max_element()))
        * DAffine3::from_translation(-middle_mm)
}

pub(crate) fn byte_window() -> Window {
    Window::new(0.0, 255.0).unwrap()
}

/// A volume held for casting, where it is and how it is shown.
pub(crate) struct Scene {
    pub(crate) caster: Caster,
    pub(crate) parameters: CastParameters,
}

impl Scene {
    pub(crate) fn new(volume: &Volume, longest_side_m: f64, settings: &Settings) -> Self {
        let placement = Placement::new(volume, world_from_patient(volume, longest_side_m));
        Self { caster: Caster::new(volume), parameters: CastParameters::new(settings, &placement) }
    }
}
