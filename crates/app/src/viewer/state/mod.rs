//! All that the viewer shows, and how: one value, changed by edits alone, saved and loaded as JSON.

mod camera;
mod clip;
mod edit;
mod light_field;
mod look;
mod pace;
mod raw;
mod stereo;
mod transfer;

pub(crate) use camera::{Camera, Face};
pub(crate) use clip::{Clip, Plane};
pub(crate) use edit::Edit;
pub(crate) use light_field::{Calibration, Grid, LightField, ShownDisplay};
pub(crate) use look::Look;
pub(crate) use pace::{Layers, Pace, WarpName};
pub(crate) use stereo::{Arrangement, EyeMethod, Stereo};
pub(crate) use transfer::Transfer;

use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use thiserror::Error;
use wheatstone_core::scene::{GradientMethod, Settings};
use wheatstone_io::RawLayout;

/// The version of the form that is read and written.
const VERSION: u64 = 1;

/// What is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct State {
    /// Version of the form.
    wheatstone_view: u64,
    /// The volume file; none is the volume that ships with the program.
    pub(crate) file: Option<PathBuf>,
    /// The layout of a raw file that was opened by its flags.
    #[serde(default, with = "raw", skip_serializing_if = "Option::is_none")]
    pub(crate) layout: Option<RawLayout>,
    pub(crate) camera: Camera,
    pub(crate) look: Look,
    pub(crate) transfer: Transfer,
    pub(crate) clip: Clip,
    pub(crate) stereo: Stereo,
    /// For the arrangements of light-field displays.
    #[serde(default)]
    pub(crate) light_field: LightField,
    pub(crate) pace: Pace,
}

/// Why a text or an edit makes no state.
#[derive(Debug, Error)]
pub(crate) enum StateError {
    /// Not JSON, a field missing or unknown, or of another shape.
    #[error("not a saved view: {0}")]
    Syntax(#[from] serde_json::Error),
    /// Of a later program.
    #[error("version {found} of the form of saved views; this program reads version {VERSION}")]
    Version {
        /// Version in the text.
        found: u64,
    },
    /// A number out of bounds, points out of order.
    #[error("{part}: {reason}")]
    Value {
        /// Which part of the state.
        part: &'static str,
        /// What is allowed.
        reason: String,
    },
}

impl Default for State {
    fn default() -> Self {
        Self {
            wheatstone_view: VERSION,
            file: None,
            layout: None,
            camera: Camera::default(),
            look: Look::default(),
            transfer: Transfer::default(),
            clip: Clip::default(),
            stereo: Stereo::default(),
            light_field: LightField::default(),
            pace: Pace::default(),
        }
    }
}

impl State {
    /// Reads a saved state.
    pub(crate) fn from_json(text: &str) -> Result<Self, StateError> {
        let state: Self = serde_json::from_str(text)?;
        if state.wheatstone_view != VERSION {
            return Err(StateError::Version { found: state.wheatstone_view });
        }
        state.check()?;
        Ok(state)
    }

    /// The text that [`State::from_json`] reads.
    pub(crate) fn to_json(&self) -> Result<String, StateError> {
        Ok(serde_json::to_string_pretty(self)?)
    }

    /// Does an edit, or leaves everything as it was.
    pub(crate) fn apply(&mut self, edit: &Edit) -> Result<(), StateError> {
        let mut edited = self.clone();
        edit.apply(&mut edited)?;
        edited.check()?;
        *self = edited;
        Ok(())
    }

    /// What the casters take.
    pub(crate) fn settings(&self) -> Result<Settings, StateError> {
        let transfer = self.transfer.function().map_err(|error| of_part("transfer", error.to_string()))?;
        let window = self.transfer.window().map_err(|error| of_part("transfer", error.to_string()))?;
        let is_preintegrated = self.look.preintegrated && !transfer.is_2d();
        Ok(Settings {
            mode: self.look.mode.with_isovalue(self.look.isovalue as f32),
            preintegrated: is_preintegrated,
            shading: self.look.shading,
            gradient: GradientMethod::CentralDifferences,
            sampling_factor: self.look.sampling_factor as f32,
            clip: self.clip.scene(),
            ..Settings::new(window, transfer)
        })
    }

    /// The warp that is shown: the one that is asked for, unless a picture is to be shown to two eyes by one that does not part them.
    pub(crate) fn warp(&self) -> WarpName {
        match self.pace.warp {
            WarpName::None | WarpName::Quad if self.stereo.shows_one_cast_to_two_eyes() => WarpName::Grid,
            asked => asked,
        }
    }

    /// What the picture can be arranged as.
    pub(crate) fn arrangements(&self) -> Vec<Arrangement> {
        let has_panel = self.light_field.lenses().is_some();
        let can_be = |arrangement: &Arrangement| *arrangement != Arrangement::Panel || has_panel;
        Arrangement::ALL.into_iter().filter(can_be).collect()
    }

    fn check_arrangement(&self) -> Result<(), String> {
        if self.arrangements().contains(&self.stereo.arrangement) {
            return Ok(());
        }
        Err("arrangement is panel: needs a display behind lenses and its calibration".to_owned())
    }

    fn check(&self) -> Result<(), StateError> {
        let parts = [
            ("camera", self.camera.check()),
            ("look", self.look.check()),
            ("transfer", self.transfer.check()),
            ("clip", self.clip.check()),
            ("stereo", self.stereo.check()),
            ("light_field", self.light_field.check()),
            ("stereo", self.check_arrangement()),
            ("pace", self.pace.check()),
        ];
        parts.into_iter().try_for_each(|(part, check)| check.map_err(|reason| of_part(part, reason)))
    }
}

fn of_part(part: &'static str, reason: String) -> StateError {
    StateError::Value { part, reason }
}

/// Refuses a number that is not within bounds.
fn within(name: &str, value: f64, lo: f64, hi: f64) -> Result<(), String> {
    if (lo..=hi).contains(&value) {
        Ok(())
    } else {
        Err(format!("{name} is {value}: must be from {lo} to {hi}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::look::ModeName;
    use std::time::Duration;
    use wheatstone_core::scene::Shading;
    use wheatstone_core::volume::VoxelType;

    fn edited() -> State {
        let layout = Some(RawLayout::new([3, 4, 5], VoxelType::ALL[1]));
        let mut state = State { file: Some("a b/c.nii.gz".into()), layout, ..State::default() };
        for edit in [
            Edit::Orbit { right_deg: 30.0, up_deg: -12.5 },
            Edit::Mode(ModeName::Iso),
            Edit::Shading(Shading::Directional { directions: 5 }),
            Edit::AddOpacityPoint([0.25, 0.125]),
            Edit::ClipPlane(Some(Plane::default())),
            Edit::Arrangement(Arrangement::Anaglyph),
        ] {
            state.apply(&edit).unwrap();
        }
        state
    }

    #[test]
    fn what_is_saved_is_loaded() {
        let state = edited();
        assert_ne!(state, State::default());
        assert_eq!(State::from_json(&state.to_json().unwrap()).unwrap(), state);
    }

    #[test]
    fn bad_states_are_refused_with_a_reason() {
        let json = edited().to_json().unwrap();
        let message = |from: &str, to: &str| {
            assert!(json.contains(from), "{from}");
            State::from_json(&json.replacen(from, to, 1)).unwrap_err().to_string()
        };
        assert!(message("\"wheatstone_view\": 1", "\"wheatstone_view\": 2").contains("version 2"));
        assert!(message("\"distance_m\":", "\"distnace_m\":").contains("distnace_m"));
        assert!(message("\"fov_deg\": 40.0", "\"fov_deg\": 400.0").contains("400"));
        assert!(message("directional:5", "directional:500").contains("directional"));
        assert!(message("0.125", "1.125").contains("opacity"));
        assert!(message("\"steps\": 32", "\"steps\": 0").contains("steps"));
        assert!(message("\"thresholds\": [", "\"thresholds\": [0.0001, ").contains("5 layers"));
        assert!(State::from_json("").is_err());
    }

    #[test]
    fn views_saved_before_layers_were_have_the_default_ones() {
        let mut view: serde_json::Value = serde_json::from_str(&edited().to_json().unwrap()).unwrap();
        view["pace"].as_object_mut().unwrap().remove("layers").unwrap();
        assert_eq!(State::from_json(&view.to_string()).unwrap(), edited());
    }

    #[test]
    fn views_saved_before_displays_were_have_the_default_one_and_panels_need_a_calibration() {
        let mut view: serde_json::Value = serde_json::from_str(&edited().to_json().unwrap()).unwrap();
        view.as_object_mut().unwrap().remove("light_field").unwrap();
        assert_eq!(State::from_json(&view.to_string()).unwrap(), edited());
        view["stereo"]["arrangement"] = "panel".into();
        assert!(State::from_json(&view.to_string()).unwrap_err().to_string().contains("needs a display"));
        view["light_field"] = serde_json::json!({ "calibration": {
            "pitch": 50, "slope": -7, "center": 0.4, "DPI": 324, "screenW": 1536, "screenH": 2048,
        } });
        assert!(State::from_json(&view.to_string()).is_ok());
        view["light_field"]["display"] = "agus-2008".into();
        assert!(State::from_json(&view.to_string()).unwrap_err().to_string().contains("has projectors"));
    }

    #[test]
    fn edits_of_what_is_not_there_are_refused_with_what_there_is() {
        let state = edited();
        let says = |edit: Edit, what: &str| {
            let mut after = state.clone();
            let error = after.apply(&edit).unwrap_err().to_string();
            assert!(error.contains(what), "{edit:?}: {error}");
            assert_eq!(after, state);
        };
        let (points, colors) = (state.transfer.opacity.len(), state.transfer.color.len());
        says(Edit::MoveOpacityPoint { index: points, to: [0.5; 2] }, "must be from 0 to 2");
        says(Edit::RemoveOpacityPoint(999), "999: must be from 0 to 2");
        says(Edit::SetColorPoint { index: colors, to: [0.5; 4] }, "must be from 0 to 1");
        says(Edit::RemoveColorPoint(usize::MAX), "must be from 0 to 1");
        says(Edit::MoveFace { face: 6, to: 0.5 }, "must be from 0 to 5");
        says(Edit::Zoom(0.0), "must be above 0");
        says(Edit::Zoom(-2.0), "must be above 0");
        let mut lonely = state.clone();
        (1..points).for_each(|_| lonely.apply(&Edit::RemoveOpacityPoint(0)).unwrap());
        assert!(lonely.apply(&Edit::RemoveOpacityPoint(0)).unwrap_err().to_string().contains("last point"));
    }

    #[test]
    fn one_cast_for_two_eyes_is_shown_by_a_warp_that_parts_them() {
        let mut state = State::default();
        for (arrangement, method, parts) in [
            (Arrangement::Mono, EyeMethod::OneCast, false),
            (Arrangement::SideBySide, EyeMethod::OneCast, true),
            (Arrangement::Anaglyph, EyeMethod::OneCast, true),
            (Arrangement::Anaglyph, EyeMethod::TwoCasts, false),
            (Arrangement::LightField, EyeMethod::OneCast, false),
        ] {
            (state.stereo.arrangement, state.stereo.method) = (arrangement, method);
            for asked in WarpName::ALL {
                state.pace.warp = asked;
                let has_parallax = matches!(asked, WarpName::Grid | WarpName::Volumetric);
                let expected = if parts && !has_parallax { WarpName::Grid } else { asked };
                assert_eq!(state.warp(), expected, "{arrangement:?} {method:?} {asked:?}");
            }
        }
    }

    #[test]
    fn views_hold_the_displays_refreshes_or_fixed_ones() {
        let mut state = State::default();
        assert!(state.to_json().unwrap().contains("\"refresh_ms\": null"));
        assert_eq!(State::from_json(&state.to_json().unwrap()).unwrap(), state);
        state.apply(&Edit::Refresh(Some(25.0))).unwrap();
        let of_display = Duration::from_millis(7);
        assert_eq!(state.pace.refresh_time(of_display), Duration::from_millis(25));
        assert_eq!(State::from_json(&state.to_json().unwrap()).unwrap(), state);
        assert!(state.apply(&Edit::Refresh(Some(0.0))).is_err());
        state.apply(&Edit::Refresh(None)).unwrap();
        assert_eq!(state.pace.refresh_time(of_display), of_display);
    }

    #[test]
    fn the_field_of_view_had_another_name() {
        let json = edited().to_json().unwrap();
        assert_eq!(State::from_json(&json.replace("fov_deg", "fov_y_deg")).unwrap(), edited());
    }

    #[test]
    fn an_edit_that_fails_changes_nothing() {
        let mut state = edited();
        let before = state.clone();
        assert!(state.apply(&Edit::SamplingFactor(-1.0)).is_err());
        assert!(state.apply(&Edit::Orbit { right_deg: f64::NAN, up_deg: 0.0 }).is_err());
        assert_eq!(state, before);
    }
}
