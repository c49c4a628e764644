//! Which button of which controller does what.

use wheatstone_core::headset::Side;

/// What hands do, as actions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Input {
    /// Pose of the fist.
    Grip,
    /// Pose of the pointing ray.
    Aim,
    /// Squeezing.
    Squeeze,
    /// The one button of a controller that has no other for the hand: it does as the fingers of a bare hand do.
    Select,
    /// The trigger.
    Trigger,
    /// The thumb-stick.
    Stick,
    /// A track pad that stands in for a thumb-stick while it is pressed.
    Pad,
    /// Whether that is pressed.
    PadPressed,
    /// The menu button.
    Menu,
    /// A button that stands in for a thumb-stick that is held to the right.
    Next,
    /// The motor.
    Haptic,
}

/// A kind of controller (an interaction profile) and what its parts are bound to.
pub(crate) struct Profile {
    /// Path of the interaction profile.
    pub(crate) path: &'static str,
    /// Parts of either hand's controller.
    both: &'static [(Input, &'static str)],
    /// Parts that only the left or only the right one has.
    one: &'static [(Side, Input, &'static str)],
}

impl Profile {
    /// What is bound to which path.
    pub(crate) fn bindings(&self) -> impl Iterator<Item = (Input, String)> {
        let path = |side, part: &str| format!("{}/{part}", user_path(side));
        let both = Side::BOTH
            .into_iter()
            .flat_map(move |side| self.both.iter().map(move |(input, part)| (*input, path(side, part))));
        both.chain(self.one.iter().map(move |(side, input, part)| (*input, path(*side, part))))
    }
}

/// The runtime's path of a hand.
pub(crate) fn user_path(side: Side) -> &'static str {
    match side {
        Side::Left => "/user/hand/left",
        Side::Right => "/user/hand/right",
    }
}

const GRIP: (Input, &str) = (Input::Grip, "input/grip/pose");
const AIM: (Input, &str) = (Input::Aim, "input/aim/pose");
const HAPTIC: (Input, &str) = (Input::Haptic, "output/haptic");
const TRIGGER: (Input, &str) = (Input::Trigger, "input/trigger/value");
const STICK: (Input, &str) = (Input::Stick, "input/thumbstick");
const MENU: (Input, &str) = (Input::Menu, "input/menu/click");

/// Every controller that is known. Runtimes map others to these.
///
/// The simple controller has one button beside the menu's: it takes hold as bare fingers do, of a face that it is near or else of the
/// volume. The right one's menu button goes to the next preset. Controllers whose menu button is the runtime's own have it on the upper face button.
pub(crate) const PROFILES: [Profile; 5] = [
    Profile {
        path: "/interaction_profiles/khr/simple_controller",
        both: &[GRIP, AIM, (Input::Select, "input/select/click"), HAPTIC],
        one: &[(Side::Left, Input::Menu, "input/menu/click"), (Side::Right, Input::Next, "input/menu/click")],
    },
    Profile {
        path: "/interaction_profiles/valve/index_controller",
        both: &[
            GRIP,
            AIM,
            (Input::Squeeze, "input/squeeze/value"),
            TRIGGER,
            STICK,
            (Input::Menu, "input/b/click"),
            HAPTIC,
        ],
        one: &[],
    },
    Profile {
        path: "/interaction_profiles/oculus/touch_controller",
        both: &[GRIP, AIM, (Input::Squeeze, "input/squeeze/value"), TRIGGER, STICK, HAPTIC],
        one: &[
            (Side::Left, Input::Menu, "input/menu/click"),
            (Side::Left, Input::Menu, "input/y/click"),
            (Side::Right, Input::Menu, "input/b/click"),
        ],
    },
    Profile {
        path: "/interaction_profiles/microsoft/motion_controller",
        both: &[GRIP, AIM, (Input::Squeeze, "input/squeeze/click"), TRIGGER, STICK, MENU, HAPTIC],
        one: &[],
    },
    Profile {
        path: "/interaction_profiles/htc/vive_controller",
        both: &[
            GRIP,
            AIM,
            (Input::Squeeze, "input/squeeze/click"),
            TRIGGER,
            (Input::Pad, "input/trackpad"),
            (Input::PadPressed, "input/trackpad/click"),
            MENU,
            HAPTIC,
        ],
        one: &[],
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_controller_can_hold_drag_and_point_with_either_hand_and_choose() {
        for profile in &PROFILES {
            let bindings: Vec<_> = profile.bindings().collect();
            let has = |side: Side, inputs: &[Input]| {
                bindings.iter().any(|(what, path)| inputs.contains(what) && path.starts_with(user_path(side)))
            };
            for side in Side::BOTH {
                for inputs in [
                    &[Input::Grip][..],
                    &[Input::Aim],
                    &[Input::Haptic],
                    &[Input::Squeeze, Input::Select],
                    &[Input::Trigger, Input::Select],
                ] {
                    assert!(has(side, inputs), "{} {side:?} {inputs:?}", profile.path);
                }
            }
            let either = |inputs: &[Input]| Side::BOTH.into_iter().any(|side| has(side, inputs));
            assert!(either(&[Input::Menu]), "{} cannot call the volume back", profile.path);
            assert!(either(&[Input::Stick, Input::Pad, Input::Next]), "{} cannot choose", profile.path);
        }
    }

    #[test]
    fn no_part_does_two_things() {
        for profile in &PROFILES {
            let paths: Vec<_> = profile.bindings().map(|(_, path)| path).collect();
            let distinct: HashSet<_> = paths.iter().collect();
            assert_eq!(distinct.len(), paths.len(), "{}", profile.path);
        }
    }

    #[test]
    fn a_pad_is_of_use_only_with_its_press() {
        for profile in &PROFILES {
            let count = |wanted| profile.bindings().filter(|(input, _)| *input == wanted).count();
            assert_eq!(count(Input::Pad), count(Input::PadPressed), "{}", profile.path);
            assert!(count(Input::Stick) == 0 || count(Input::Pad) == 0, "{}", profile.path);
        }
    }
}
