//! Keys: each sets a mode, moves the camera, or carries out a command.

use winit::event::{ElementState, KeyEvent};
use winit::keyboard::{Key, KeyCode, ModifiersState, NamedKey, PhysicalKey};

use crate::app::actions::compare::hold_reference;
use crate::app::command::{Command, CompareWith, Side};
use crate::app::engine::Engine;
use crate::app::execute::execute;
use crate::app::keys;
use crate::app::screen::Screen;
use crate::app::state::State;
use crate::app::state::dialog::Dialog;
use crate::app::state::selection::Selected;
use crate::scene::CameraController;
use crate::session::Session;
use crate::settings::LightSettings;
use crate::shader::annotation::neighbors;

/// Handles a key. `is_synthetic`: winit made the event up; `taken`: it belongs to the user interface. Returns whether to redraw.
pub(super) fn on_keyboard(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
    event: &KeyEvent,
    is_synthetic: bool,
    taken: bool,
) -> bool {
    let pressed = event.state == ElementState::Pressed;
    if let PhysicalKey::Code(code) = event.physical_key
        && fly_key(&mut screen.camera, code, pressed && screen.mouse.right)
    {
        return true;
    }
    // A release always counts, so that nothing stays held.
    if pressed && screen.panels.defaults.is_open() {
        return false;
    }
    // Escape closes an open list or menu, and nothing else.
    if pressed && event.logical_key == Key::Named(NamedKey::Escape) && screen.has_open_popup() {
        return false;
    }
    let reads_keys = state.reads_keys();
    let is_space = event.physical_key == PhysicalKey::Code(KeyCode::Space);
    if is_space && !pressed && hold_reference(state, false) {
        return true;
    }
    // The search of the palette has the keys from the moment it opens, which may be before egui knows. The key that opens
    // it also closes it.
    let is_open_key = is_function_key(&event.logical_key) || opens_palette(&event.logical_key, screen.mouse.modifiers);
    let taken = (taken || screen.panels.palette.is_open()) && !is_open_key;
    if !pressed || (reads_keys && !is_shortcut(&event.logical_key, screen.mouse.modifiers)) {
        // A press that winit makes up when the window gets the focus is none for shaders.
        let counts = !pressed || !(taken || event.repeat || is_synthetic);
        return counts && shader_key(state, event.physical_key, pressed) && reads_keys;
    }
    if is_space && !taken && !event.repeat && !is_synthetic {
        return hold_reference(state, true);
    }
    if let Some(side) = side(event.physical_key, screen.mouse.modifiers).filter(|_| !taken) {
        execute(state, engine, Command::ViewFrom(side));
        return true;
    }
    if let Some(command) = bookmark(event.physical_key, screen.mouse.modifiers).filter(|_| !taken) {
        execute(state, engine, command);
        return true;
    }
    let steps = matches!(&event.logical_key, Key::Character(text) if text == "[" || text == "]");
    !taken && (steps || !event.repeat) && on_key(state, engine, screen, &event.logical_key)
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

/// The side of the model that a key of the numeric keypad asks for.
fn side(key: PhysicalKey, modifiers: ModifiersState) -> Option<Side> {
    let opposite = modifiers.control_key();
    match key {
        PhysicalKey::Code(KeyCode::Numpad1) => Some(if opposite { Side::Back } else { Side::Front }),
        PhysicalKey::Code(KeyCode::Numpad3) => Some(if opposite { Side::Left } else { Side::Right }),
        PhysicalKey::Code(KeyCode::Numpad7) => Some(if opposite { Side::Bottom } else { Side::Top }),
        _ => None,
    }
}

/// The camera that a digit keeps with Ctrl and Shift, or returns to with Ctrl.
fn bookmark(key: PhysicalKey, modifiers: ModifiersState) -> Option<Command> {
    let PhysicalKey::Code(code) = key else { return None };
    let number = keys::digit(code).filter(|digit| *digit > 0 && modifiers.control_key())?;
    Some(if modifiers.shift_key() { Command::KeepCamera(number) } else { Command::RecallCamera(number) })
}

/// Whether a key types nothing and so is never meant for a text.
fn is_function_key(key: &Key) -> bool {
    matches!(key, Key::Named(NamedKey::F1 | NamedKey::F5 | NamedKey::F12))
}

/// Whether a key opens and closes the palette.
fn opens_palette(key: &Key, modifiers: ModifiersState) -> bool {
    modifiers.control_key() && matches!(key, Key::Character(text) if text.eq_ignore_ascii_case("p"))
}

/// Whether a key remains Specula's while the picture reads keys.
fn is_shortcut(key: &Key, modifiers: ModifiersState) -> bool {
    match key {
        key if is_function_key(key) => true,
        Key::Named(NamedKey::Space) => modifiers.control_key(),
        Key::Named(named) => matches!(named, NamedKey::Escape | NamedKey::Home),
        Key::Character(_) => modifiers.control_key(),
        _ => false,
    }
}

/// Tells the shaders that a key went down or up. Returns whether they know the key. A key's release always counts, so that no
/// key gets stuck.
fn shader_key(state: &mut State, key: PhysicalKey, pressed: bool) -> bool {
    let PhysicalKey::Code(code) = key else { return false };
    let Some(number) = keys::number(code) else { return false };
    let keys = state.playback.keys();
    if pressed {
        keys.press(number)
    } else {
        keys.release(number)
    }
    true
}

fn on_key(state: &mut State, engine: &mut Engine, screen: &mut Screen, key: &Key) -> bool {
    match key {
        Key::Named(NamedKey::F1) => screen.panels.show_keys ^= true,
        Key::Named(NamedKey::F5) => execute(state, engine, Command::Reload),
        Key::Named(NamedKey::F12) => execute(state, engine, Command::Screenshot),
        Key::Named(NamedKey::Escape) if screen.panels.show_keys => screen.panels.show_keys = false,
        Key::Named(NamedKey::Escape) if screen.panels.open_gallery.is_open => {
            screen.panels.open_gallery.is_open = false
        }
        // A click pins a pixel and selects what it shows; Escape takes both back.
        Key::Named(NamedKey::Escape)
            if state.selected != Selected::Nothing
                || (state.workspace.sight.inspector && state.inspection.is_pinned()) =>
        {
            state.inspection.unpin();
            execute(state, engine, Command::Select(Selected::Nothing));
        }
        Key::Named(NamedKey::Escape) if state.grid.is_on() => state.grid.end(),
        Key::Named(NamedKey::Escape) => set_mode(&mut state.session, 0),
        Key::Named(NamedKey::Home) => execute(state, engine, Command::FrameModel),
        Key::Character(text) => {
            let Some(key) = text.chars().next() else { return false };
            return on_character(state, engine, screen, key.to_ascii_lowercase());
        }
        _ => return false,
    }
    true
}

/// A key that types a character. While the picture reads keys, Ctrl is what tells it from the picture's.
fn on_character(state: &mut State, engine: &mut Engine, screen: &mut Screen, key: char) -> bool {
    let modifiers = screen.mouse.modifiers;
    let (control, shift) = (modifiers.control_key(), modifiers.shift_key());
    let is_ignored = control && !state.reads_keys();
    let session = &mut state.session;
    match key {
        'p' if control => screen.panels.palette.toggle(),
        'k' if control => {
            let with = if state.compare.is_on() { CompareWith::Nothing } else { CompareWith::ThisPicture };
            execute(state, engine, Command::Compare(with));
        }
        'h' if control => execute(state, engine, Command::HideSelected),
        'h' if modifiers.alt_key() => execute(state, engine, Command::ShowAll),
        'o' if control => execute(state, engine, Command::Choose(Dialog::File)),
        'q' if control => execute(state, engine, Command::Quit),
        'z' if control => execute(state, engine, if shift { Command::Redo } else { Command::Undo }),
        'y' if control => execute(state, engine, Command::Redo),
        _ if is_ignored => return false,
        '/' => execute(state, engine, Command::IsolateSelected),
        '?' => screen.panels.show_keys ^= true,
        '[' => step_mode(session, false),
        ']' => step_mode(session, true),
        'h' => screen.panels.visible = !screen.panels.visible,
        'r' => execute(state, engine, Command::FrameModel),
        'l' => {
            let lights = &mut session.settings.lights;
            lights.spin = if lights.spin == 0.0 { 30.0 } else { LightSettings::default().spin };
        }
        digit @ '1'..='9' => set_mode(session, digit as usize - '1' as usize),
        '0' => set_mode(session, 9),
        letter => {
            let modes = session.shaders.iter().flat_map(|shaders| &shaders.modes);
            let Some(slug) = modes.into_iter().find(|mode| mode.key == Some(letter)).map(|mode| mode.slug.clone())
            else {
                return false;
            };
            // The key of the current mode returns to the final picture.
            let again = slug == session.settings.mode;
            session.settings.mode = if again { "final".into() } else { slug };
        }
    }
    true
}

fn set_mode(session: &mut Session, index: usize) {
    if let Some(mode) = session.shaders.as_ref().and_then(|shaders| shaders.modes.get(index)) {
        session.settings.mode = mode.slug.clone();
    }
}

/// Selects the next mode of the list, or the one before.
fn step_mode(session: &mut Session, forward: bool) {
    let (Some(shaders), features) = (&session.shaders, session.features()) else { return };
    if let Some([before, after]) = neighbors(&shaders.modes, &session.settings.mode, features) {
        session.settings.mode = if forward { after } else { before }.slug.clone();
    }
}
