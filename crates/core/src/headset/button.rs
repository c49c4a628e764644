//! Something pressed more or less as a button.

/// How far it must be pressed to be down.
const DOWN: f32 = 0.7;

/// How far it must be let go to be up again.
const UP: f32 = 0.3;

/// A squeeze, a pull or a stick that is down from [`DOWN`] on and up again from [`UP`] on: what trembles in between
/// changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Button {
    is_down: bool,
}

impl Button {
    /// How far it is pressed now, 0 to 1; whether it has gone down by that.
    pub(super) fn press(&mut self, how_far: f32) -> bool {
        let was_down = self.is_down;
        if how_far >= DOWN {
            self.is_down = true;
        } else if how_far <= UP {
            self.is_down = false;
        }
        self.is_down && !was_down
    }

    pub(super) fn is_down(self) -> bool {
        self.is_down
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_trembles_in_between_changes_nothing() {
        let mut button = Button::default();
        let pressed = [0.0, 0.69, 0.7, 0.4, 0.9, 0.31, f32::NAN, 0.3, 0.6, 0.31, 1.0];
        let went_down = pressed.map(|how_far| button.press(how_far));
        let expected = [false, false, true, false, false, false, false, false, false, false, true];
        assert_eq!(went_down, expected);
        assert!(button.is_down());
    }
}
