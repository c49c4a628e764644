//! Random dots on the layers of a wedding cake: what tells whether a display shows depth (LF §6).

use super::{PhantomError, sample};
use crate::volume::{Grid, Volume, Voxels};
use glam::{DVec2, DVec3};

/// Three concentric layers with random dots, seen along their axis, around the middle of a screen.
///
/// Dots and edges of layers are where an eye on the axis sees them, whatever the depth: from there a deep cake and a flat one look
/// the same, and with one still eye there is nothing to tell them apart by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeddingCake {
    /// Which of the random patterns.
    pub seed: u64,
    /// Width, height and depth of the volume, centred on the screen's middle, x to the right, y up, z towards the eye; metres.
    pub size_m: [f64; 3],
    /// How far before the screen the innermost layer is, and the outermost behind it, metres.
    pub half_depth_m: f64,
    /// How far from the screen, on the axis, the eye is for which dots are alike, metres.
    pub eye_distance_m: f64,
    /// Side of a dot on the screen, metres.
    pub dot_m: f64,
}

/// Values of the layers where no dot is, around the layers, and of dots: from around a layer to its dots values pass none of another kind.
pub const CAKE_VALUES: [u8; 3] = [0, 128, 255];

/// Radii of the inner and the middle layer on the screen, in halves of the volume's smaller side.
const RADII: [f64; 2] = [0.35, 0.7];

/// Voxels along z that a layer is thick.
const THICKNESS_VOXELS: f64 = 2.0;

/// How far before the screen the innermost layer of LF's deep cake and of its flat one is, metres.
pub(super) const DEEP_M: f64 = 0.1;
pub(super) const FLAT_M: f64 = 0.01;

impl WeddingCake {
    /// A cake for the display of LF (`ProjectorArray::of_paper`) and an eye where its virtual viewer is, 1 m away. It is so much larger than
    /// the screen that its edges are not seen, which would tell how far behind the screen they are. Dots are 1 cm large: 4 pixels of the
    /// display as far as 10 cm from its screen.
    pub fn of_paper(half_depth_m: f64) -> Self {
        Self { seed: 1, size_m: [0.5, 0.375, 0.22], half_depth_m, eye_distance_m: 1.0, dot_m: 0.01 }
    }

    /// The volume at a number of voxels along each axis.
    ///
    /// # Errors
    /// As [`Phantom::volume`](super::Phantom::volume), and sizes that are not above 0.
    pub fn volume(&self, dims: [usize; 3]) -> Result<Volume, PhantomError> {
        let spacing_mm = [0, 1, 2].map(|axis| 1000.0 * self.size_m[axis] / dims[axis] as f64);
        let grid = Grid::centred(dims, spacing_mm)?;
        let half_layer_m = 0.5 * THICKNESS_VOXELS * spacing_mm[2] / 1000.0;
        let value = |texture: DVec3| self.value((texture - 0.5) * DVec3::from(self.size_m), half_layer_m);
        Ok(Volume::new(grid, Voxels::U8(sample(dims, value)?))?)
    }

    fn value(&self, at_m: DVec3, half_layer_m: f64) -> u8 {
        let on_screen_m = at_m.truncate() * (self.eye_distance_m / (self.eye_distance_m - at_m.z));
        let radius = on_screen_m.length() / (0.5 * self.size_m[0].min(self.size_m[1]));
        let layer_m = match RADII.iter().filter(|&&inner| radius >= inner).count() {
            0 => self.half_depth_m,
            1 => 0.0,
            _ => -self.half_depth_m,
        };
        if (at_m.z - layer_m).abs() > half_layer_m {
            return CAKE_VALUES[1];
        }
        if self.is_dot(on_screen_m) { CAKE_VALUES[2] } else { CAKE_VALUES[0] }
    }

    fn is_dot(&self, on_screen_m: DVec2) -> bool {
        let [column, row] = (on_screen_m / self.dot_m).floor().to_array().map(|index| index as i64 as u64);
        let mixed = mix(mix(self.seed ^ mix(column)) ^ row);
        mixed & 1 == 1
    }
}

/// The finaliser of `SplitMix64` (Steele, Lea and Flood 2014): all bits of a number spread over all bits.
fn mix(number: u64) -> u64 {
    let z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
