//! Hands at a volume.

use super::button::Button;
use super::crop::{Crop, Picked};
use super::drag::Drags;
use super::grasp::Grasp;
use super::pinches::Pinches;
use super::stick::Sticks;
use super::{Stand, Tick};
use crate::scene::{Clip, Placement};
use crate::view::{AnatomicalDirection, world_from_patient};
use crate::volume::{Grid, Window};
use glam::DAffine3;

/// What two hands do with a volume, tick by tick: where it stands, and what part of it is shown.
///
/// | | |
/// |---|---|
/// | squeeze of one hand | carries the volume, wherever the hand is |
/// | squeeze of both hands | carries it with the line between the hands, and scales it with the line's length |
/// | trigger | drags the face of the visible box, or the clip plane, that the hand points at |
/// | pinch of a bare hand | near a face of the visible box or the clip plane it drags that, else it squeezes |
/// | stick left, right | preset before, next preset |
/// | stick up, down | shifts the window; with the trigger pulled it widens or narrows the window |
/// | menu button | brings the volume back before the eyes, as large as it is |
///
/// A hand that holds the volume drags nothing. The clip plane goes along with the volume. Nothing else moves the volume: not the
/// head, not a lost tracking, not letting go.
///
/// ```
/// use glam::{DQuat, DVec3};
/// use wheatstone_core::head::Pose;
/// use wheatstone_core::headset::{Hand, Interaction, Scale, Stand, Tick};
/// use wheatstone_core::scene::Clip;
/// use wheatstone_core::view::AnatomicalDirection::Superior;
/// use wheatstone_core::volume::{Grid, Window};
///
/// let grid = Grid::centred([64, 64, 64], [1.0; 3])?;
/// let eyes = Pose { position_m: DVec3::new(0.0, 1.6, 0.0), orientation: DQuat::IDENTITY };
/// let stand = Stand::before(&eyes, &grid, Superior, Scale::Human);
/// let mut interaction = Interaction::new(&grid, Superior, stand, &Clip::default());
/// let mut window = Window::new(0.0, 255.0)?;
///
/// // The right hand closes, and then moves up by 5 cm.
/// for (refresh, height_m) in [1.2, 1.25].into_iter().enumerate() {
///     let grip = Pose { position_m: DVec3::new(0.2, height_m, -0.4), ..eyes };
///     let right = Hand { grip: Some(grip), aim: Some(grip), squeeze: 1.0, ..Hand::default() };
///     let (display_time_s, period_s) = (refresh as f64 / 90.0, 1.0 / 90.0);
///     let tick = Tick { display_time_s, period_s, eyes: None, hands: [Hand::default(), right] };
///     let changes = interaction.update(&tick, window);
///     assert_eq!(changes.grabbed, [false, refresh == 0]);
///     assert_eq!(changes.has_moved, refresh == 1);
///     window = changes.window;
/// }
/// let carried_m = interaction.stand().pose.position_m - stand.pose.position_m;
/// assert!((carried_m - 0.05 * DVec3::Y).length() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Interaction {
    grid: Grid,
    up: AnatomicalDirection,
    upright_from_texture: DAffine3,
    stand: Stand,
    crop: Crop,
    pinches: Pinches,
    grasp: Grasp,
    drags: Drags,
    sticks: Sticks,
    menus: [Button; 2],
}

/// What a tick has changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Changes {
    /// Whether the volume stands elsewhere, or is of another size: [`Interaction::placement`].
    pub has_moved: bool,
    /// Whether another part of the volume is shown, or the plane has gone along with it: [`Interaction::clip`].
    pub has_clipped: bool,
    /// Which hands have taken hold of something: time for a haptic tick.
    pub grabbed: [bool; 2],
    /// How many presets to go on by; back if negative.
    pub preset_steps: i32,
    /// Values that are normalised to [0, 1] from now on.
    pub window: Window,
}

impl Interaction {
    /// A volume that stands somewhere, with a direction of the patient up, of which a part is shown.
    pub fn new(grid: &Grid, up: AnatomicalDirection, stand: Stand, clip: &Clip) -> Self {
        Self {
            grid: grid.clone(),
            up,
            upright_from_texture: world_from_patient(grid, up) * grid.patient_from_texture(),
            stand,
            crop: Crop::new(clip, &stand),
            pinches: Pinches::default(),
            grasp: Grasp::default(),
            drags: Drags::default(),
            sticks: Sticks::default(),
            menus: Default::default(),
        }
    }

    /// What the hands do next, while values are normalised by a window.
    pub fn update(&mut self, tick: &Tick, window: Window) -> Changes {
        let (stand_before, clip_before) = (self.stand, self.clip());
        if let (true, Some(eyes)) = (self.is_called_back(tick), tick.between_eyes()) {
            self.put(Stand::as_long_before(&eyes, &self.grid, self.up, self.stand.longest_side_m));
        }
        let hands = self.pinches.update(&tick.hands, &self.crop, &self.stand, self.upright_from_texture);
        let (stand, grabbed) = self.grasp.update(self.stand, &hands);
        self.stand = stand;
        let dragged = self.drags.update(
            &mut self.crop,
            &hands,
            self.grasp.is_closed(),
            &self.stand,
            self.upright_from_texture,
        );
        let wish = self.sticks.update(tick.display_time_s, &hands, self.drags.is_pulled());
        Changes {
            has_moved: self.stand != stand_before,
            has_clipped: self.clip() != clip_before,
            grabbed: [0, 1].map(|side: usize| grabbed[side] || dragged[side]),
            preset_steps: wish.steps,
            window: window.shifted_and_stretched(wish.shift, wish.stretch).unwrap_or(window),
        }
    }

    /// Whether a menu button has gone down.
    fn is_called_back(&mut self, tick: &Tick) -> bool {
        let pressed = [0, 1].map(|side: usize| self.menus[side].press(f32::from(tick.hands[side].menu)));
        pressed.contains(&true)
    }

    /// The direction of the patient that is up.
    pub fn up(&self) -> AnatomicalDirection {
        self.up
    }

    /// Where the volume stands.
    pub fn stand(&self) -> &Stand {
        &self.stand
    }

    /// Puts the volume elsewhere, such as before the eyes again; hands that hold it carry it on from there.
    pub fn put(&mut self, stand: Stand) {
        self.stand = stand;
        self.grasp.let_be();
        self.drags.let_go();
    }

    /// Shows another part of the volume; what is being dragged is let go.
    pub fn show(&mut self, clip: &Clip) {
        self.crop = Crop::new(clip, &self.stand);
        self.drags.let_go();
    }

    /// The volume's place in the world.
    pub fn placement(&self) -> Placement {
        self.stand.placement(&self.grid, self.up)
    }

    /// What part of the volume is shown, with the plane where it is in the world.
    pub fn clip(&self) -> Clip {
        self.crop.clip(&self.stand)
    }

    /// The same with the plane where it is in the volume's upright space, in which the longest side is 1 m.
    pub fn upright_clip(&self) -> Clip {
        self.crop.upright_clip()
    }

    /// Shows another part of the volume, which is told in its upright space; what is being dragged is let go.
    pub fn show_upright(&mut self, clip: &Clip) {
        self.crop = Crop::new(clip, &Stand::UPRIGHT);
        self.drags.let_go();
    }

    /// What each hand points at and would drag, or drags: something to be drawn.
    pub fn hovered(&self) -> [Option<Picked>; 2] {
        self.drags.picked(&self.stand)
    }
}
