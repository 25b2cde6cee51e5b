//! The keys of a frame. Their numbers are those of JavaScript's `keyCode`, which Shadertoy uses as well.

use std::str::FromStr;

use crate::message::did_you_mean;

/// Keys whose names are neither a letter, a digit nor F1 to F12.
const NAMED: [(&str, u8); 47] = [
    ("Backspace", 8),
    ("Tab", 9),
    ("Enter", 13),
    ("Shift", 16),
    ("Ctrl", 17),
    ("Alt", 18),
    ("Pause", 19),
    ("CapsLock", 20),
    ("Escape", 27),
    ("Space", 32),
    ("PageUp", 33),
    ("PageDown", 34),
    ("End", 35),
    ("Home", 36),
    ("Left", 37),
    ("Up", 38),
    ("Right", 39),
    ("Down", 40),
    ("Insert", 45),
    ("Delete", 46),
    ("Meta", 91),
    ("Numpad0", 96),
    ("Numpad1", 97),
    ("Numpad2", 98),
    ("Numpad3", 99),
    ("Numpad4", 100),
    ("Numpad5", 101),
    ("Numpad6", 102),
    ("Numpad7", 103),
    ("Numpad8", 104),
    ("Numpad9", 105),
    ("NumpadMultiply", 106),
    ("NumpadAdd", 107),
    ("NumpadSubtract", 109),
    ("NumpadDecimal", 110),
    ("NumpadDivide", 111),
    ("Semicolon", 186),
    ("Equal", 187),
    ("Comma", 188),
    ("Minus", 189),
    ("Period", 190),
    ("Slash", 191),
    ("Backquote", 192),
    ("BracketLeft", 219),
    ("Backslash", 220),
    ("BracketRight", 221),
    ("Quote", 222),
];

/// A bit for each key: bit `key % 32` of element `key / 32`.
type Bits = [u32; 8];

/// The state of all keys in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Keys {
    /// Keys that are down.
    pub down: Bits,
    /// Keys that went down since the frame before.
    pub pressed: Bits,
    /// Keys that went down an odd number of times.
    pub toggled: Bits,
}

impl Keys {
    /// A key went down.
    pub fn press(&mut self, key: u8) {
        let (element, bit) = place(key);
        self.down[element] |= bit;
        self.pressed[element] |= bit;
        self.toggled[element] ^= bit;
    }

    /// A key went up.
    pub fn release(&mut self, key: u8) {
        let (element, bit) = place(key);
        self.down[element] &= !bit;
    }

    /// All keys went up.
    pub fn release_all(&mut self) {
        self.down = Bits::default();
    }

    /// The keys of the next frame if none goes down or up in between.
    #[must_use]
    pub fn held(self) -> Self {
        Self { pressed: Bits::default(), ..self }
    }

    /// The keys as a frame shows them. A key that went down and up since the frame before counts as down, so that no frame
    /// misses it.
    #[must_use]
    pub fn in_frame(self) -> Self {
        Self { down: std::array::from_fn(|i| self.down[i] | self.pressed[i]), ..self }
    }

    /// `interface::Frame::keys`. One array, since a block with several arrays of the same type is compiled whole at each edit.
    pub(crate) fn words(&self) -> [u32; 24] {
        bytemuck::cast([self.down, self.pressed, self.toggled])
    }

    /// Whether a key went down since the frame before.
    pub fn any_pressed(&self) -> bool {
        self.pressed != Bits::default()
    }
}

/// Parses names of keys, as `A,Space,Left`. The keys have just gone down.
impl FromStr for Keys {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut keys = Self::default();
        let names = key_names();
        for typed in text.split(',').map(str::trim) {
            let Some((_, key)) = names.iter().find(|(name, _)| name.eq_ignore_ascii_case(typed)) else {
                let hint = did_you_mean(typed, names.iter().map(|(name, _)| name.as_str()));
                return Err(format!("no key is named `{typed}`.{hint} Expected names as A,7,Space,Left,F1"));
            };
            keys.press(*key);
        }
        Ok(keys)
    }
}

/// The names of all keys, with their numbers.
pub fn key_names() -> Vec<(String, u8)> {
    let signs = (b'0'..=b'9').chain(b'A'..=b'Z').map(|sign| (char::from(sign).to_string(), sign));
    let functions = (1..=12).map(|number| (format!("F{number}"), 111 + number));
    NAMED.iter().map(|(name, key)| ((*name).to_owned(), *key)).chain(signs).chain(functions).collect()
}

fn place(key: u8) -> (usize, u32) {
    (usize::from(key / 32), 1 << (key % 32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn has(bits: Bits, key: u8) -> bool {
        let (element, bit) = place(key);
        bits[element] & bit != 0
    }

    fn states(keys: Keys, key: u8) -> [bool; 3] {
        [keys.down, keys.pressed, keys.toggled].map(|bits| has(bits, key))
    }

    #[test]
    fn a_key_goes_down_once_and_toggles() {
        let mut keys = Keys::default();
        keys.press(65);
        assert_eq!(states(keys, 65), [true; 3]);
        assert_eq!(states(keys, 66), [false; 3]);
        keys = keys.held();
        assert_eq!(states(keys, 65), [true, false, true]);
        keys.release(65);
        assert_eq!(states(keys, 65), [false, false, true]);
        keys.press(65);
        assert_eq!(states(keys, 65), [true, true, false]);
        keys.release_all();
        assert_eq!(states(keys, 65), [false, true, false]);
        assert_eq!(states(keys.in_frame(), 65), [true, true, false], "a short press shows in one frame");
        assert_eq!(states(keys.held().in_frame(), 65), [false; 3]);
    }

    #[test]
    fn keys_have_names() {
        let keys: Keys = "A, space,left,F12,Quote".parse().unwrap();
        for key in [65, 32, 37, 123, 222] {
            assert_eq!(states(keys, key), [true; 3], "{key}");
        }
        let message = "A,Spcae".parse::<Keys>().unwrap_err();
        assert!(message.contains("`Spcae`. Did you mean `Space`?"), "{message}");
        assert!("".parse::<Keys>().is_err());
    }

    /// The constants in GLSL are the names here: `KEY_PAGE_UP` is `PageUp`.
    #[test]
    fn the_shaders_know_the_same_keys() {
        let text = include_str!("../../shaders/common/keys.glsl");
        let in_glsl = |name: &str| {
            let mut out = String::from("KEY");
            for (at, c) in name.char_indices() {
                if at == 0 || c.is_ascii_uppercase() {
                    out.push('_');
                }
                out.push(c.to_ascii_uppercase());
            }
            out
        };
        let mut expected: Vec<String> =
            key_names().iter().map(|(name, key)| format!("const uint {} = {key}u;", in_glsl(name))).collect();
        let constants = text.lines().filter(|line| line.starts_with("const uint KEY_"));
        let mut found: Vec<String> = constants.map(str::to_owned).collect();
        expected.sort();
        found.sort();
        assert_eq!(found, expected);
    }
}
