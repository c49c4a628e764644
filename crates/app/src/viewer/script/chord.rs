//! A key, perhaps with others held.

use egui::{Event, Key, Modifiers};
use serde::{Deserialize, Serialize};

/// A key by its name or sign, after `Ctrl+` and `Shift+` if those are held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub(crate) struct Chord {
    key: Key,
    shift: bool,
    ctrl: bool,
}

impl Chord {
    /// A key alone.
    pub(super) fn plain(key: Key) -> Self {
        Self { key, shift: false, ctrl: false }
    }

    /// What happens when it is pressed.
    pub(super) fn down(self) -> [Event; 2] {
        [Event::ModifiersChanged(self.modifiers()), self.event(true)]
    }

    /// What happens when it is released.
    pub(super) fn up(self) -> [Event; 2] {
        [self.event(false), Event::ModifiersChanged(Modifiers::NONE)]
    }

    fn event(self, pressed: bool) -> Event {
        let (key, modifiers) = (self.key, self.modifiers());
        Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }
    }

    fn modifiers(self) -> Modifiers {
        Modifiers { shift: self.shift, ctrl: self.ctrl, command: self.ctrl, ..Modifiers::NONE }
    }
}

impl TryFrom<String> for Chord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let (ctrl, rest) = text.strip_prefix("Ctrl+").map_or((false, text.as_str()), |rest| (true, rest));
        let (shift, name) = rest.strip_prefix("Shift+").map_or((false, rest), |name| (true, name));
        let key = Key::from_name(name).ok_or_else(|| format!("no key is called {name:?}"))?;
        Ok(Self { key, shift, ctrl })
    }
}

impl From<Chord> for String {
    fn from(chord: Chord) -> Self {
        let [ctrl, shift] = [(chord.ctrl, "Ctrl+"), (chord.shift, "Shift+")]
            .map(|(is_held, name)| if is_held { name } else { "" });
        format!("{ctrl}{shift}{}", chord.key.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chord_is_written_as_it_is_read() {
        for text in ["S", "Ctrl+S", "Shift+Right", "Ctrl+Shift+Home", "Ctrl+Plus"] {
            assert_eq!(String::from(Chord::try_from(text.to_owned()).unwrap()), text);
        }
        assert_eq!(Chord::try_from("+".to_owned()).unwrap(), Chord::plain(Key::Plus));
        for bad in ["", "Ctrl+", "Alt+S", "Ctrl", "Any"] {
            assert!(Chord::try_from(bad.to_owned()).unwrap_err().contains("no key"), "{bad}");
        }
    }
}
