//! What hands do with their controllers.

use crate::bindings::{Input, PROFILES, Profile, user_path};
use crate::error::{Called, XrError};
use crate::space::World;
use openxr as xr;
use wheatstone_core::headset::{Hand, Pinch, Side};

/// A thumb-stick that is held there.
const TO_THE_RIGHT: xr::Vector2f = xr::Vector2f { x: 1.0, y: 0.0 };

/// The actions of a session, bound to the parts of controllers.
pub(crate) struct Actions {
    set: xr::ActionSet,
    grip: xr::Action<xr::Posef>,
    aim: xr::Action<xr::Posef>,
    squeeze: xr::Action<f32>,
    select: xr::Action<f32>,
    trigger: xr::Action<f32>,
    stick: xr::Action<xr::Vector2f>,
    pad: xr::Action<xr::Vector2f>,
    pad_pressed: xr::Action<bool>,
    menu: xr::Action<bool>,
    next: xr::Action<bool>,
    haptic: xr::Action<xr::Haptic>,
    sides: [OneSide; 2],
}

/// What belongs to one hand.
struct OneSide {
    path: xr::Path,
    grip: xr::Space,
    aim: xr::Space,
}

impl Actions {
    pub(crate) fn new(session: &xr::Session<xr::Vulkan>) -> Result<Self, XrError> {
        let instance = session.instance();
        let path = |side| instance.string_to_path(user_path(side)).called("xrStringToPath");
        let paths = [path(Side::Left)?, path(Side::Right)?];
        let set = instance.create_action_set("hands", "Hands", 0).called("xrCreateActionSet")?;
        let grip = action(&set, &paths, "grip", "Hand")?;
        let aim = action(&set, &paths, "aim", "Pointer")?;
        let [left, right] = paths.map(|path| {
            let space = |action: &xr::Action<xr::Posef>| {
                action.create_space(session, path, xr::Posef::IDENTITY).called("xrCreateActionSpace")
            };
            Ok::<_, XrError>(OneSide { path, grip: space(&grip)?, aim: space(&aim)? })
        });
        let actions = Self {
            grip,
            aim,
            squeeze: action(&set, &paths, "squeeze", "Take hold")?,
            select: action(&set, &paths, "select", "Take hold of what is near")?,
            trigger: action(&set, &paths, "trigger", "Drag the crop box")?,
            stick: action(&set, &paths, "stick", "Presets and window")?,
            pad: action(&set, &paths, "pad", "Presets and window (track pad)")?,
            pad_pressed: action(&set, &paths, "pad_pressed", "Presets and window (track pad pressed)")?,
            menu: action(&set, &paths, "menu", "Bring back")?,
            next: action(&set, &paths, "next", "Next preset")?,
            haptic: action(&set, &paths, "haptic", "Felt tick")?,
            sides: [left?, right?],
            set,
        };
        for profile in &PROFILES {
            actions.suggest(instance, profile)?;
        }
        session.attach_action_sets(&[&actions.set]).called("xrAttachSessionActionSets")?;
        Ok(actions)
    }

    /// Binds the parts of a kind of controller; one that the runtime does not know is passed over.
    fn suggest(&self, instance: &xr::Instance, profile: &Profile) -> Result<(), XrError> {
        let path = |text: &str| instance.string_to_path(text).called("xrStringToPath");
        let bindings = profile
            .bindings()
            .map(|(input, part)| Ok(self.binding(input, path(&part)?)))
            .collect::<Result<Vec<_>, XrError>>()?;
        match instance.suggest_interaction_profile_bindings(path(profile.path)?, &bindings) {
            Err(xr::sys::Result::ERROR_PATH_UNSUPPORTED) => Ok(()),
            suggested => suggested.called("xrSuggestInteractionProfileBindings"),
        }
    }

    fn binding(&self, input: Input, path: xr::Path) -> xr::Binding<'_> {
        match input {
            Input::Grip => xr::Binding::new(&self.grip, path),
            Input::Aim => xr::Binding::new(&self.aim, path),
            Input::Select => xr::Binding::new(&self.select, path),
            Input::Next => xr::Binding::new(&self.next, path),
            Input::Squeeze => xr::Binding::new(&self.squeeze, path),
            Input::Trigger => xr::Binding::new(&self.trigger, path),
            Input::Stick => xr::Binding::new(&self.stick, path),
            Input::Pad => xr::Binding::new(&self.pad, path),
            Input::PadPressed => xr::Binding::new(&self.pad_pressed, path),
            Input::Menu => xr::Binding::new(&self.menu, path),
            Input::Haptic => xr::Binding::new(&self.haptic, path),
        }
    }

    /// Takes note of what hands do now; without the focus they do nothing.
    pub(crate) fn sync(&self, session: &xr::Session<xr::Vulkan>) -> Result<(), XrError> {
        session.sync_actions(&[xr::ActiveActionSet::new(&self.set)]).called("xrSyncActions")
    }

    /// What a hand does since the last [`Actions::sync`], and where it is at a time; none without a controller.
    pub(crate) fn hand(
        &self,
        session: &xr::Session<xr::Vulkan>,
        side: Side,
        world: &World,
        time: xr::Time,
    ) -> Result<Option<Hand>, XrError> {
        let of = &self.sides[side.index()];
        if !self.grip.is_active(session, of.path).called("xrGetActionStatePose")? {
            return Ok(None);
        }
        let [squeeze, trigger] = [&self.squeeze, &self.trigger]
            .map(|action| state(action, session, of.path).map(|value| value.unwrap_or(0.0)));
        let pad_pressed = state(&self.pad_pressed, session, of.path)?.unwrap_or(false);
        let stick_action = if pad_pressed { &self.pad } else { &self.stick };
        let stick = if state(&self.next, session, of.path)?.unwrap_or(false) {
            TO_THE_RIGHT
        } else {
            state(stick_action, session, of.path)?.unwrap_or_default()
        };
        let aim = world.locate(&of.aim, time)?;
        let selected = state(&self.select, session, of.path)?;
        let pinch = aim
            .zip(selected)
            .map(|(aim, closed)| Pinch { position_m: aim.position_m, closed: within(closed, 0.0) });
        Ok(Some(Hand {
            grip: world.locate(&of.grip, time)?,
            aim,
            squeeze: within(squeeze?, 0.0),
            trigger: within(trigger?, 0.0),
            stick: [within(stick.x, -1.0), within(stick.y, -1.0)],
            menu: state(&self.menu, session, of.path)?.unwrap_or(false),
            pinch,
        }))
    }

    /// Makes a controller vibrate.
    pub(crate) fn pulse(
        &self,
        session: &xr::Session<xr::Vulkan>,
        side: Side,
        vibration: &xr::HapticVibration<'_>,
    ) -> Result<(), XrError> {
        self.haptic
            .apply_feedback(session, self.sides[side.index()].path, vibration)
            .called("xrApplyHapticFeedback")
    }

    /// Which kinds of controllers the hands hold: paths of interaction profiles.
    pub(crate) fn controllers(
        &self,
        session: &xr::Session<xr::Vulkan>,
    ) -> Result<[Option<String>; 2], XrError> {
        let name = |of: &OneSide| {
            let profile =
                session.current_interaction_profile(of.path).called("xrGetCurrentInteractionProfile")?;
            if profile == xr::Path::NULL {
                return Ok(None);
            }
            session.instance().path_to_string(profile).called("xrPathToString").map(Some)
        };
        let [left, right] = &self.sides;
        Ok([name(left)?, name(right)?])
    }
}

fn action<T: xr::ActionTy>(
    set: &xr::ActionSet,
    paths: &[xr::Path; 2],
    name: &str,
    shown: &str,
) -> Result<xr::Action<T>, XrError> {
    set.create_action(name, shown, paths).called("xrCreateAction")
}

/// The state of an action of a hand, if anything is bound to it.
fn state<T: xr::ActionInput>(
    action: &xr::Action<T>,
    session: &xr::Session<xr::Vulkan>,
    path: xr::Path,
) -> Result<Option<T>, XrError> {
    let state = action.state(session, path).called("xrGetActionState")?;
    Ok(state.is_active.then_some(state.current_state))
}

/// A value between a least one and 1; 0 for one that is no number.
fn within(value: f32, least: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(least, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stay_within_their_bounds() {
        assert_eq!([within(1.5, 0.0), within(-0.5, 0.0), within(f32::NAN, 0.0)], [1.0, 0.0, 0.0]);
        assert_eq!([within(-1.5, -1.0), within(-0.5, -1.0), within(f32::NAN, -1.0)], [-1.0, -0.5, 0.0]);
    }
}
