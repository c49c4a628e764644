//! Where the volume stands in the room.

use crate::head::Pose;
use crate::scene::Placement;
use crate::view::{AnatomicalDirection, world_from_patient};
use crate::volume::Grid;
use glam::{DAffine3, DQuat, DVec3};

/// How far before the eyes the volume's middle is at first, metres: within reach of an arm that is a little bent.
const ARMS_LENGTH_M: f64 = 0.6;

/// Nearest that the volume's front is to the eyes at first, metres: where near vision is tested. Eyes that are 63 mm apart
/// converge by 9° there; displays are focused two metres away or so, and nearer things tire.
const NEAREST_M: f64 = 0.4;

/// Fall of the line from the eyes to the volume's middle: 15° below the horizon, where seated and standing people look at rest
/// (MIL-STD-1472, normal line of sight).
const FALL: f64 = 0.267_949_192_431_122_7;

/// Longest side of a volume at human scale, metres: a little more than a head is high, less than a forearm with its hand, so
/// that both hands can hold it at shoulder width; 28° at arm's length.
const HUMAN_SIDE_M: f64 = 0.3;

/// How large a volume is at first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// As large as what two hands hold: the longest side is 0.3 m, whatever it is of.
    #[default]
    Human,
    /// A millimetre of the patient is a millimetre.
    True,
}

impl Scale {
    /// Length of the longest side of a volume, metres.
    pub fn longest_side_m(self, grid: &Grid) -> f64 {
        match self {
            Self::Human => HUMAN_SIDE_M,
            Self::True => 1e-3 * grid.size_mm().max_element(),
        }
    }
}

/// Where a volume stands: a rigid pose and one scale for all directions.
///
/// **Upright** space, which the pose turns into the world's, has the volume's middle at its origin, the patient upright along +Y
/// and facing +Z, and the longest side as its unit of length: it is the world of
/// [`world_from_patient`](crate::view::world_from_patient).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stand {
    /// Of the volume's middle.
    pub pose: Pose,
    /// Length of the volume's longest side, metres.
    pub longest_side_m: f64,
}

impl Stand {
    /// Upright space itself.
    pub const UPRIGHT: Self =
        Self { pose: Pose { position_m: DVec3::ZERO, orientation: DQuat::IDENTITY }, longest_side_m: 1.0 };

    /// Before somebody whose eyes are at a pose: the middle at arm's length, or as far as it takes for the front not to be
    /// uncomfortably near, 15° below the eyes, the patient facing them. Only the heading of the eyes counts: the volume is
    /// upright however the head is tilted.
    pub fn before(eyes: &Pose, grid: &Grid, up: AnatomicalDirection, scale: Scale) -> Self {
        Self::as_long_before(eyes, grid, up, scale.longest_side_m(grid))
    }

    /// The same for a volume whose longest side is of some metres.
    pub fn as_long_before(eyes: &Pose, grid: &Grid, up: AnatomicalDirection, longest_side_m: f64) -> Self {
        let upright_from_texture = world_from_patient(grid, up) * grid.patient_from_texture();
        let front = corners(upright_from_texture).map(|corner| corner.z).fold(0.0, f64::max);
        let distance_m = ARMS_LENGTH_M.max(NEAREST_M + front * longest_side_m);
        let heading = heading(eyes.orientation);
        let middle_m = heading * DVec3::new(0.0, -FALL * distance_m, -distance_m);
        Self { pose: Pose { position_m: eyes.position_m + middle_m, orientation: heading }, longest_side_m }
    }

    /// Upright space to the world.
    pub fn world_from_upright(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(self.longest_side_m),
            self.pose.orientation,
            self.pose.position_m,
        )
    }

    /// The place of a volume that stands there, with a direction of the patient up.
    pub fn placement(&self, grid: &Grid, up: AnatomicalDirection) -> Placement {
        Placement::of_grid(grid, self.world_from_upright() * world_from_patient(grid, up))
    }
}

/// The turn about +Y that an orientation contains (its twist); none where it turns all upside down.
fn heading(orientation: DQuat) -> DQuat {
    let length = orientation.y.hypot(orientation.w);
    if length > 1e-9 {
        DQuat::from_xyzw(0.0, orientation.y / length, 0.0, orientation.w / length)
    } else {
        DQuat::IDENTITY
    }
}

/// The corners of the volume in another space.
pub(super) fn corners(target_from_texture: DAffine3) -> impl Iterator<Item = DVec3> {
    (0..8_u32).map(move |bits| {
        let corner = DVec3::from([0, 1, 2].map(|axis| f64::from(bits >> axis & 1)));
        target_from_texture.transform_point3(corner)
    })
}
