//! Keys that carry out a command.

use winit::event::KeyEvent;
use winit::keyboard::{self, ModifiersState, NamedKey, PhysicalKey};

use crate::app::key_codes;

/// The number of the digit 0 of the numeric keypad.
const NUMPAD: u8 = 96;

/// A key with its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) struct Shortcut {
    key: Key,
    modifiers: ModifiersState,
    /// Whether it also counts while a text field has the keyboard.
    pub(in crate::app) is_everywhere: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Key {
    /// A key that types this character, in lower case.
    Types(char),
    Named(NamedKey),
    /// A key at the place of this number in JavaScript's `keyCode`.
    At(u8),
}

impl Shortcut {
    /// The key that types a character.
    pub(super) const fn key(character: char) -> Self {
        Self::of(Key::Types(character))
    }

    pub(super) const fn named(key: NamedKey) -> Self {
        Self::of(Key::Named(key))
    }

    /// The keys that type these characters.
    pub(super) const fn keys<const N: usize>(characters: &[u8; N]) -> [Self; N] {
        let (mut keys, mut at) = ([Self::key('0'); N], 0);
        while at < N {
            keys[at] = Self::key(characters[at] as char);
            at += 1;
        }
        keys
    }

    /// The digits 1 to 9, by their places, with modifiers.
    pub(super) const fn digits(modifiers: ModifiersState) -> [Self; 9] {
        let (mut keys, mut at) = ([Self { modifiers, ..Self::of(Key::At(b'1')) }; 9], 0);
        while at < 9 {
            keys[at].key = Key::At(b'1' + at as u8);
            at += 1;
        }
        keys
    }

    /// A digit of the numeric keypad.
    pub(super) const fn numpad(digit: u8) -> Self {
        Self::of(Key::At(NUMPAD + digit))
    }

    const fn of(key: Key) -> Self {
        Self { key, modifiers: ModifiersState::empty(), is_everywhere: false }
    }

    pub(super) const fn ctrl(self) -> Self {
        Self { modifiers: self.modifiers.union(ModifiersState::CONTROL), ..self }
    }

    pub(super) const fn shift(self) -> Self {
        Self { modifiers: self.modifiers.union(ModifiersState::SHIFT), ..self }
    }

    pub(super) const fn alt(self) -> Self {
        Self { modifiers: self.modifiers.union(ModifiersState::ALT), ..self }
    }

    pub(super) const fn everywhere(self) -> Self {
        Self { is_everywhere: true, ..self }
    }

    /// Number of modifiers, if the event is this key. Modifiers that it does not name do not matter, but for Ctrl with a key that types
    /// a character: while the picture reads keys, that is how the key means Specula instead of the picture.
    pub(super) fn matches(&self, event: &KeyEvent, held: ModifiersState, reads_keys: bool) -> Option<u32> {
        let is_key = match (self.key, &event.logical_key) {
            (Key::Types(character), keyboard::Key::Character(text)) => {
                let typed = text.chars().next().map(|typed| typed.to_ascii_lowercase());
                let is_meant = reads_keys || !held.control_key() || self.modifiers.control_key();
                typed == Some(character) && is_meant
            }
            (Key::Named(key), keyboard::Key::Named(pressed)) => key == *pressed,
            (Key::At(number), _) => match event.physical_key {
                PhysicalKey::Code(code) => key_codes::number(code) == Some(number),
                PhysicalKey::Unidentified(_) => false,
            },
            _ => false,
        };
        (is_key && held.contains(self.modifiers)).then(|| self.modifiers.bits().count_ones())
    }

    /// Name of the key, as lists of keys show it.
    pub(in crate::app) fn text(&self) -> String {
        let key = match self.key {
            Key::Types(character) => character.to_ascii_uppercase().to_string(),
            Key::Named(NamedKey::Escape) => "Esc".to_owned(),
            Key::Named(key) => format!("{key:?}"),
            Key::At(number) if number >= NUMPAD => format!("Numpad {}", number - NUMPAD),
            Key::At(digit) => char::from(digit).to_string(),
        };
        let names =
            [(ModifiersState::CONTROL, "Ctrl+"), (ModifiersState::SHIFT, "Shift+"), (ModifiersState::ALT, "Alt+")];
        let held = names.into_iter().filter(|(modifier, _)| self.modifiers.contains(*modifier));
        held.map(|(_, name)| name).chain([key.as_str()]).collect()
    }
}
