//! The one way to change a state.

use super::look::shading_text;
use super::{
    Arrangement, Calibration, Camera, Clip, EyeMethod, Face, Layers, Plane, ShownDisplay, State, StateError,
    Transfer, WarpName, of_part,
};
use crate::camera::Up;
use crate::look::ModeName;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use wheatstone_core::scene::Shading;

/// A change of what is shown; panels, mouse, keys and scripts make no other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Edit {
    /// The eye circles what it looks at.
    Orbit {
        right_deg: f64,
        up_deg: f64,
    },
    /// Eye and target move sideways by parts of what the shorter side of an eye's picture shows.
    Pan {
        right: f64,
        up: f64,
    },
    /// The eye comes so many times as near.
    Zoom(f64),
    /// Eye and target move along the view's axes.
    Fly {
        right_m: f64,
        up_m: f64,
        forward_m: f64,
    },
    /// The eye turns where it is.
    Turn {
        right_deg: f64,
        up_deg: f64,
    },
    /// The eye looks at a side of the volume.
    Face(Face),
    /// The eye goes where it was at first.
    ResetCamera,
    /// Field of view of the shorter side of an eye's picture, degrees.
    FieldOfView(f64),
    Mode(ModeName),
    #[serde(with = "shading_text")]
    Shading(Shading),
    Isovalue(f64),
    SamplingFactor(f64),
    Preintegrated(bool),
    Background([f32; 3]),
    Up(Up),
    Transfer(Transfer),
    /// The window shifts by parts of its width, and becomes so many times as wide.
    WindowLevel {
        shift: f64,
        stretch: f64,
    },
    /// The window's bounds, in the file's unit.
    Window([f64; 2]),
    /// A point moves: value, opacity.
    MoveOpacityPoint {
        index: usize,
        to: [f32; 2],
    },
    AddOpacityPoint([f32; 2]),
    RemoveOpacityPoint(usize),
    /// A point moves and is coloured: value, red, green, blue.
    SetColorPoint {
        index: usize,
        to: [f32; 4],
    },
    AddColorPoint(f32),
    RemoveColorPoint(usize),
    /// A face of the box moves (0–2: low x, y, z; 3–5: high), texture space.
    MoveFace {
        face: usize,
        to: f64,
    },
    ClipPlane(Option<Plane>),
    /// Box, plane and handles, all at once.
    Clip(Clip),
    /// Whether the handles of box and plane are shown.
    ClipHandles(bool),
    /// Nothing is cut away any more.
    ResetClip,
    Arrangement(Arrangement),
    EyeMethod(EyeMethod),
    /// Between the eyes, metres.
    EyeDistance(f64),
    /// The light-field display, by name or description; the eye goes where it is made for.
    Display(ShownDisplay),
    /// How the display's lenses lie on its panel.
    Calibration(Option<Calibration>),
    /// Where the eye is before the display, metres to the right, up and towards it from the middle of the screen; none is where the
    /// display is made for.
    DisplayEye(Option<DVec3>),
    Warp(WarpName),
    /// What volumetric warps keep, and how rays step through it.
    Layers(Layers),
    /// Time from one refresh to the next, ms; none is the display's.
    Refresh(Option<f64>),
}

impl Edit {
    /// Changes the state as far as it can; the caller checks what comes out.
    ///
    /// # Errors
    /// What is to be changed is not there.
    pub(super) fn apply(&self, state: &mut State) -> Result<(), StateError> {
        let (camera, look, transfer) = (&mut state.camera, &mut state.look, &mut state.transfer);
        match *self {
            Self::Orbit { right_deg, up_deg } => camera.orbit(right_deg, up_deg),
            Self::Pan { right, up } => camera.pan(right, up),
            Self::Zoom(factor) if factor > 0.0 => camera.zoom(factor),
            Self::Zoom(factor) => {
                return Err(of_part("camera", format!("zoom is {factor}: must be above 0")));
            }
            Self::Fly { right_m, up_m, forward_m } => camera.fly(right_m, up_m, forward_m),
            Self::Turn { right_deg, up_deg } => camera.turn(right_deg, up_deg),
            Self::Face(face) => camera.face(face),
            Self::ResetCamera => *camera = Camera::default(),
            Self::FieldOfView(degrees) => camera.fov_deg = degrees,
            Self::Mode(mode) => look.mode = mode,
            Self::Shading(shading) => look.shading = shading,
            Self::Isovalue(value) => look.isovalue = value.clamp(0.0, 1.0),
            Self::SamplingFactor(factor) => look.sampling_factor = factor,
            Self::Preintegrated(preintegrated) => look.preintegrated = preintegrated,
            Self::Background(background) => look.background = background,
            Self::Up(up) => look.up = up,
            Self::Transfer(ref whole) => transfer.clone_from(whole),
            Self::WindowLevel { shift, stretch } => transfer.window_level(shift, stretch),
            Self::Window(window) => transfer.window = window,
            Self::MoveOpacityPoint { index, to } => of_transfer(transfer.move_opacity(index, to))?,
            Self::AddOpacityPoint(point) => transfer.add_opacity(point),
            Self::RemoveOpacityPoint(index) => of_transfer(transfer.remove_opacity(index))?,
            Self::SetColorPoint { index, to } => of_transfer(transfer.set_color(index, to))?,
            Self::AddColorPoint(at) => transfer.add_color(at),
            Self::RemoveColorPoint(index) => of_transfer(transfer.remove_color(index))?,
            Self::MoveFace { face, to } => {
                state.clip.move_face(face, to).map_err(|reason| of_part("clip", reason))?;
            }
            Self::ClipPlane(plane) => state.clip.plane = plane,
            Self::Clip(clip) => state.clip = clip,
            Self::ClipHandles(has_handles) => state.clip.has_handles = has_handles,
            Self::ResetClip => state.clip = Clip { has_handles: state.clip.has_handles, ..Clip::default() },
            Self::Arrangement(arrangement) => state.stereo.arrangement = arrangement,
            Self::EyeMethod(method) => state.stereo.method = method,
            Self::EyeDistance(distance_m) => state.stereo.eye_distance_m = distance_m,
            Self::Display(ref display) => {
                state.light_field.display.clone_from(display);
                (state.light_field.calibration, state.light_field.eye_m) = (None, None);
                if state.stereo.arrangement == Arrangement::Panel {
                    state.stereo.arrangement = Arrangement::LightField;
                }
            }
            Self::Calibration(ref calibration) => state.light_field.calibration.clone_from(calibration),
            Self::DisplayEye(eye_m) => state.light_field.eye_m = eye_m,
            Self::Warp(warp) => state.pace.warp = warp,
            Self::Layers(ref layers) => state.pace.layers.clone_from(layers),
            Self::Refresh(refresh_ms) => state.pace.refresh_ms = refresh_ms,
        }
        Ok(())
    }
}

fn of_transfer(edited: Result<(), String>) -> Result<(), StateError> {
    edited.map_err(|reason| of_part("transfer", reason))
}
