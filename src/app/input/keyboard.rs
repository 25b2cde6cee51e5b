//! Keys: shortcuts of commands, letters of modes, flight, and keys that shaders read.

use winit::event::{ElementState, KeyEvent};
use winit::keyboard::{Key, KeyCode, ModifiersState, NamedKey, PhysicalKey};

use crate::app::actions::compare::hold_reference;
use crate::app::command;
use crate::app::command::modes::TOGGLE_MODE;
use crate::app::command::spec::Command;
use crate::app::engine::Engine;
use crate::app::interface::Interface;
use crate::app::key_codes;
use crate::app::state::State;
use crate::scene::CameraController;

/// Handles a key. `is_synthetic`: winit made the event up; `taken`: it belongs to the user interface. Returns whether to redraw.
pub(super) fn on_keyboard(
    state: &mut State,
    engine: &mut Engine,
    interface: &mut Interface,
    event: &KeyEvent,
    is_synthetic: bool,
    taken: bool,
) -> bool {
    let pressed = event.state == ElementState::Pressed;
    if let PhysicalKey::Code(code) = event.physical_key
        && fly_key(&mut interface.camera, code, pressed && interface.mouse.right)
    {
        return true;
    }
    // A release always counts, so that nothing stays held.
    if pressed && interface.panels.defaults.is_open() {
        return false;
    }
    // Escape closes an open list or menu, and nothing else.
    if pressed && event.logical_key == Key::Named(NamedKey::Escape) && interface.has_open_popup() {
        return false;
    }
    let (reads_keys, modifiers) = (state.reads_keys(), interface.mouse.modifiers);
    let is_space = event.physical_key == PhysicalKey::Code(KeyCode::Space);
    if is_space && !pressed && hold_reference(state, false) {
        return true;
    }
    let found = command::of_key(state, event, modifiers);
    let is_everywhere = found.as_ref().is_some_and(|(_, shortcut)| shortcut.is_everywhere);
    // The search of the palette has the keys from the moment it opens, which may be before egui knows.
    let taken = (taken || interface.panels.palette.is_open()) && !is_everywhere;
    if !pressed || (reads_keys && !is_shortcut(&event.logical_key, modifiers, is_everywhere)) {
        // A press that winit makes up when the window gets the focus is none for shaders.
        let counts = !pressed || !(taken || event.repeat || is_synthetic);
        return counts && shader_key(state, event.physical_key, pressed) && reads_keys;
    }
    if taken {
        return false;
    }
    if is_space && !event.repeat && !is_synthetic {
        return hold_reference(state, true);
    }
    if event.logical_key == Key::Named(NamedKey::Escape) && interface.panels.close_list() {
        return true;
    }
    // Ctrl with a letter that is no shortcut means nothing, unless it tells the letter from the picture's.
    let is_letter = reads_keys || !modifiers.control_key();
    let command = match found {
        Some((command, _)) => Some(command),
        None if is_letter => mode_command(state, &event.logical_key),
        None => None,
    };
    let Some(command) = command.filter(|command| !event.repeat || command.about.repeats) else { return false };
    command::execute(state, engine, command);
    // Keys that follow in the same frame are already for a palette that has just been opened.
    interface.carry_out(&state.workspace.take_requests());
    true
}

/// Flies with W A S D E Q while the right button is held. A key's release always counts, so that no key gets stuck.
fn fly_key(camera: &mut CameraController, code: KeyCode, pressed: bool) -> bool {
    let (axis, sign) = match code {
        KeyCode::KeyD => (0, 1.0),
        KeyCode::KeyA => (0, -1.0),
        KeyCode::KeyE => (1, 1.0),
        KeyCode::KeyQ => (1, -1.0),
        KeyCode::KeyW => (2, 1.0),
        KeyCode::KeyS => (2, -1.0),
        _ => return false,
    };
    if pressed {
        camera.fly[axis] = sign;
    } else if camera.fly[axis] == sign {
        camera.fly[axis] = 0.0;
    }
    pressed
}

/// Whether a key remains Specula's while the picture reads keys.
fn is_shortcut(key: &Key, modifiers: ModifiersState, is_everywhere: bool) -> bool {
    match key {
        Key::Named(NamedKey::Space) | Key::Character(_) => modifiers.control_key(),
        Key::Named(named) => is_everywhere || matches!(named, NamedKey::Escape | NamedKey::Home),
        _ => false,
    }
}

/// Tells the shaders that a key went down or up. Returns whether they know the key. A key's release always counts, so that no
/// key gets stuck.
fn shader_key(state: &mut State, key: PhysicalKey, pressed: bool) -> bool {
    let PhysicalKey::Code(code) = key else { return false };
    let Some(number) = key_codes::number(code) else { return false };
    let keys = state.playback.keys();
    if pressed {
        keys.press(number)
    } else {
        keys.release(number)
    }
    true
}

/// The command of a letter that a mode has as its key.
fn mode_command(state: &State, key: &Key) -> Option<Command> {
    let Key::Character(text) = key else { return None };
    let letter = text.chars().next()?.to_ascii_lowercase();
    let modes = state.session.shaders.iter().flat_map(|shaders| &shaders.modes);
    let mode = modes.into_iter().find(|mode| mode.key == Some(letter))?;
    Some(TOGGLE_MODE.with(mode.slug.clone()))
}
