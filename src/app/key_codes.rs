//! The numbers of keys for shaders.

use winit::keyboard::KeyCode;

const LETTERS: [KeyCode; 26] = [
    KeyCode::KeyA,
    KeyCode::KeyB,
    KeyCode::KeyC,
    KeyCode::KeyD,
    KeyCode::KeyE,
    KeyCode::KeyF,
    KeyCode::KeyG,
    KeyCode::KeyH,
    KeyCode::KeyI,
    KeyCode::KeyJ,
    KeyCode::KeyK,
    KeyCode::KeyL,
    KeyCode::KeyM,
    KeyCode::KeyN,
    KeyCode::KeyO,
    KeyCode::KeyP,
    KeyCode::KeyQ,
    KeyCode::KeyR,
    KeyCode::KeyS,
    KeyCode::KeyT,
    KeyCode::KeyU,
    KeyCode::KeyV,
    KeyCode::KeyW,
    KeyCode::KeyX,
    KeyCode::KeyY,
    KeyCode::KeyZ,
];
const DIGITS: [KeyCode; 10] = [
    KeyCode::Digit0,
    KeyCode::Digit1,
    KeyCode::Digit2,
    KeyCode::Digit3,
    KeyCode::Digit4,
    KeyCode::Digit5,
    KeyCode::Digit6,
    KeyCode::Digit7,
    KeyCode::Digit8,
    KeyCode::Digit9,
];
const NUMPAD: [KeyCode; 10] = [
    KeyCode::Numpad0,
    KeyCode::Numpad1,
    KeyCode::Numpad2,
    KeyCode::Numpad3,
    KeyCode::Numpad4,
    KeyCode::Numpad5,
    KeyCode::Numpad6,
    KeyCode::Numpad7,
    KeyCode::Numpad8,
    KeyCode::Numpad9,
];
const FUNCTIONS: [KeyCode; 12] = [
    KeyCode::F1,
    KeyCode::F2,
    KeyCode::F3,
    KeyCode::F4,
    KeyCode::F5,
    KeyCode::F6,
    KeyCode::F7,
    KeyCode::F8,
    KeyCode::F9,
    KeyCode::F10,
    KeyCode::F11,
    KeyCode::F12,
];

/// The number of a key in JavaScript's `keyCode`, by its position on a US keyboard.
pub(super) fn number(key: KeyCode) -> Option<u8> {
    let rows: [(&[KeyCode], u8); 4] = [(&LETTERS, b'A'), (&DIGITS, b'0'), (&NUMPAD, 96), (&FUNCTIONS, 112)];
    let in_row = |(keys, first): &(&[KeyCode], u8)| {
        let at = keys.iter().position(|other| *other == key)?;
        u8::try_from(at).ok().map(|at| first + at)
    };
    if let Some(number) = rows.iter().find_map(in_row) {
        return Some(number);
    }
    Some(match key {
        KeyCode::Backspace => 8,
        KeyCode::Tab => 9,
        KeyCode::Enter | KeyCode::NumpadEnter => 13,
        KeyCode::ShiftLeft | KeyCode::ShiftRight => 16,
        KeyCode::ControlLeft | KeyCode::ControlRight => 17,
        KeyCode::AltLeft | KeyCode::AltRight => 18,
        KeyCode::Pause => 19,
        KeyCode::CapsLock => 20,
        KeyCode::Escape => 27,
        KeyCode::Space => 32,
        KeyCode::PageUp => 33,
        KeyCode::PageDown => 34,
        KeyCode::End => 35,
        KeyCode::Home => 36,
        KeyCode::ArrowLeft => 37,
        KeyCode::ArrowUp => 38,
        KeyCode::ArrowRight => 39,
        KeyCode::ArrowDown => 40,
        KeyCode::Insert => 45,
        KeyCode::Delete => 46,
        KeyCode::SuperLeft | KeyCode::SuperRight => 91,
        KeyCode::NumpadMultiply => 106,
        KeyCode::NumpadAdd => 107,
        KeyCode::NumpadSubtract => 109,
        KeyCode::NumpadDecimal => 110,
        KeyCode::NumpadDivide => 111,
        KeyCode::Semicolon => 186,
        KeyCode::Equal => 187,
        KeyCode::Comma => 188,
        KeyCode::Minus => 189,
        KeyCode::Period => 190,
        KeyCode::Slash => 191,
        KeyCode::Backquote => 192,
        KeyCode::BracketLeft => 219,
        KeyCode::Backslash => 220,
        KeyCode::BracketRight => 221,
        KeyCode::Quote => 222,
        _ => return None,
    })
}
