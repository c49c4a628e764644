//! The display that LF describes.

use super::description::VERSION;
use super::{Description, ImageRect, Packing, Projector, ProjectorArray, VirtualViewer};

/// Projectors (LF §6).
const COUNT: u32 = 96;

/// Those of them at each side that are seen in a mirror.
const IN_EACH_MIRROR: u32 = 16;

/// Distance of the emitters from the screen, metres.
const BEHIND_M: f64 = 1.0;

/// How much higher those stand that aim at a mirror, metres.
const RAISED_M: f64 = 0.05;

impl ProjectorArray {
    /// The display of LF §6: 96 projectors of 320 × 240 pixels of s₀ = 1.25 mm and Φ = 0.8°, 16 to a frame of 1280 × 1024.
    ///
    /// The paper does not say where its emitters and mirrors are. Here all of them light the whole screen of 0.4 × 0.3 m from 1 m
    /// behind, so far apart that neighbours are Φ apart from the middle of the screen; the 16 outermost at each side are what is
    /// seen, in mirrors at the sides, of projectors that stand above others. The virtual viewer is 1 m away, as high as the screen.
    pub fn of_paper() -> Self {
        let beam_angle_deg = 0.8_f64;
        let pitch_m = 2.0 * BEHIND_M * (0.5 * beam_angle_deg.to_radians()).tan();
        let mirror_m = 0.5 * f64::from(COUNT - 2 * IN_EACH_MIRROR) * pitch_m;
        let image = ImageRect { left_m: -0.2, right_m: 0.2, down_m: -0.15, up_m: 0.15 };
        let projector = |id: u32| {
            let x_m = (f64::from(id) - 0.5 * f64::from(COUNT - 1)) * pitch_m;
            if x_m.abs() < mirror_m {
                return Projector { id, emitter_m: [x_m, 0.0, -BEHIND_M], image };
            }
            // It throws its image to where the mirror shows the screen.
            let mirror_m = mirror_m.copysign(x_m);
            let in_mirror = |x_m: f64| 2.0 * mirror_m - x_m;
            let thrown =
                ImageRect { left_m: in_mirror(image.right_m), right_m: in_mirror(image.left_m), ..image };
            let standing = Projector { id, emitter_m: [in_mirror(x_m), RAISED_M, -BEHIND_M], image: thrown };
            standing.reflected(mirror_m, id)
        };
        Self {
            description: Description {
                wheatstone_projector_array: VERSION,
                screen_size_m: [0.4, 0.3],
                pixel_size_m: 0.001_25,
                beam_angle_deg,
                viewer: VirtualViewer { height_m: 0.0, distance_m: 1.0 },
                image_size_px: [320, 240],
                projectors: (0..COUNT).map(projector).collect(),
                packing: Packing { frame_size_px: [1280, 1024], header_rows: 8 },
            },
        }
    }
}
