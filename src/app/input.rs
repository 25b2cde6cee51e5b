//! Keys and mouse. Events that egui does not consume control the camera, the modes and the viewer. While the picture reads keys,
//! those that type a character go to its shaders instead.

use std::time::{Duration, Instant};

use glam::{Vec2, Vec3};
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::keyboard::{Key, KeyCode, ModifiersState, NamedKey, PhysicalKey};

use super::command::{Command, CompareWith, Side};
use super::dialog::Dialog;
use super::keys;
use super::screen::Screen;
use super::selection::Selected;
use super::viewer::Viewer;
use crate::frame::BEYOND;
use crate::scene::CameraController;
use crate::session::Session;
use crate::settings::LightSettings;

/// State of the mouse.
#[derive(Default)]
pub(super) struct Mouse {
    /// Position in pixels of the window.
    pub(super) at: Vec2,
    /// Whether the mouse is over the picture, not over a panel.
    pub(super) over: bool,
    left: bool,
    middle: bool,
    right: bool,
    modifiers: ModifiersState,
    /// Time and place of the last press of the left button, for double clicks.
    last_press: Option<(Instant, Vec2)>,
    /// Where the left button went down, while it may still become a click: the mouse has not been dragged.
    click: Option<Vec2>,
}

/// Most time between the presses of a double click.
const DOUBLE_CLICK: Duration = Duration::from_millis(400);
/// Most pixels between them.
const SAME_PLACE: f32 = 4.0;

/// Handles an event, unless egui has consumed it (`taken`). Returns whether to redraw.
pub(super) fn on_window_event(viewer: &mut Viewer, event: &WindowEvent, screen: &mut Screen, taken: bool) -> bool {
    match event {
        WindowEvent::ModifiersChanged(modifiers) => {
            screen.mouse.modifiers = modifiers.state();
            false
        }
        WindowEvent::KeyboardInput { event, is_synthetic, .. } => {
            let pressed = event.state == ElementState::Pressed;
            if let PhysicalKey::Code(code) = event.physical_key
                && fly_key(&mut screen.camera, code, pressed && screen.mouse.right)
            {
                return true;
            }
            let reads_keys = viewer.reads_keys();
            let is_space = event.physical_key == PhysicalKey::Code(KeyCode::Space);
            if is_space && !pressed && viewer.hold_reference(false) {
                return true;
            }
            // The search of the palette has the keys from the moment it opens, which may be before egui knows. The key that opens
            // it also closes it.
            let is_open_key =
                is_function_key(&event.logical_key) || opens_palette(&event.logical_key, screen.mouse.modifiers);
            let taken = (taken || viewer.panels.palette.is_open()) && !is_open_key;
            if !pressed || (reads_keys && !is_shortcut(&event.logical_key, screen.mouse.modifiers)) {
                // A press that winit makes up when the window gets the focus is none for shaders.
                let counts = !pressed || !(taken || event.repeat || *is_synthetic);
                return counts && shader_key(viewer, event.physical_key, pressed) && reads_keys;
            }
            if is_space && !taken && !event.repeat && !*is_synthetic {
                return viewer.hold_reference(true);
            }
            if let Some(side) = side(event.physical_key, screen.mouse.modifiers).filter(|_| !taken) {
                viewer.execute(Command::ViewFrom(side));
                return true;
            }
            if let Some(command) = bookmark(event.physical_key, screen.mouse.modifiers).filter(|_| !taken) {
                viewer.execute(command);
                return true;
            }
            let steps = matches!(&event.logical_key, Key::Character(text) if text == "[" || text == "]");
            !taken && (steps || !event.repeat) && on_key(viewer, &event.logical_key, screen.mouse.modifiers)
        }
        WindowEvent::Focused(false) => {
            viewer.playback.keys().release_all();
            viewer.playback.release_buttons();
            viewer.hold_reference(false) || viewer.reads_keys()
        }
        WindowEvent::MouseInput { state, button, .. } => {
            let pressed = *state == ElementState::Pressed && !taken && inside(screen, screen.mouse.at);
            if let Some(bit) = button_bit(*button) {
                viewer.playback.set_button(bit, pressed);
            }
            match button {
                MouseButton::Left => return on_left_button(viewer, screen, pressed),
                MouseButton::Middle => screen.mouse.middle = pressed,
                MouseButton::Right => {
                    screen.mouse.right = pressed;
                    screen.camera.fly = Vec3::ZERO;
                }
                _ => {}
            }
            false
        }
        WindowEvent::CursorMoved { position, .. } => {
            on_cursor_moved(viewer, screen, Vec2::new(position.x as f32, position.y as f32))
        }
        WindowEvent::CursorLeft { .. } => {
            viewer.playback.hover(BEYOND);
            std::mem::take(&mut screen.mouse.over)
        }
        WindowEvent::MouseWheel { delta, .. } if !taken && inside(screen, screen.mouse.at) => {
            let steps = match delta {
                MouseScrollDelta::LineDelta(_, lines) => *lines,
                MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
            };
            let Some(view) = screen.camera_view() else { return false };
            CameraController::dolly(&mut viewer.session.settings.camera, &view, steps);
            true
        }
        _ => false,
    }
}

/// Moves the mouse to `at`, in pixels of the window: what it drags, and what shaders know of it. Returns whether to redraw.
fn on_cursor_moved(viewer: &mut Viewer, screen: &mut Screen, at: Vec2) -> bool {
    let delta = (at - screen.mouse.at) / screen.rect.size.1.max(1) as f32;
    let is_over = inside(screen, at);
    let was_over = std::mem::replace(&mut screen.mouse.over, is_over);
    screen.mouse.at = at;
    let [x, y] = in_picture(screen, at);
    let (width, height) = screen.rect.size;
    let is_inside = is_over && x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32;
    viewer.playback.hover(if is_inside { [x, y] } else { BEYOND });
    screen.mouse.click = screen.mouse.click.filter(|start| start.distance(at) <= SAME_PLACE);
    if screen.mouse.left {
        viewer.playback.drag([x, y]);
    }
    drag(viewer, screen, delta) || was_over || screen.mouse.over
}

/// The bit of a button in `interface::Frame::mouse_buttons`.
fn button_bit(button: MouseButton) -> Option<u32> {
    match button {
        MouseButton::Left => Some(1),
        MouseButton::Right => Some(2),
        MouseButton::Middle => Some(4),
        _ => None,
    }
}

/// Handles the left button: a press in the picture of a shader, a double click that focuses, a click that picks. Returns whether to
/// redraw.
fn on_left_button(viewer: &mut Viewer, screen: &mut Screen, pressed: bool) -> bool {
    let was = std::mem::replace(&mut screen.mouse.left, pressed);
    let is_double = pressed && is_double_click(&mut screen.mouse);
    let place = screen.mouse.at;
    let clicked = screen.mouse.click.take().filter(|start| start.distance(place) <= SAME_PLACE);
    screen.mouse.click = (pressed && !is_double && !has_modifier(&screen.mouse)).then_some(place);
    match pressed {
        true => viewer.playback.press(in_picture(screen, screen.mouse.at)),
        false if was => viewer.playback.release(),
        false => {}
    }
    if is_double {
        return focus(viewer, screen);
    }
    let is_click = clicked.is_some() && was && !pressed;
    if is_click && keep_mode_at(viewer, screen) {
        return true;
    }
    let Some((x, y)) = screen.mouse_pixel().filter(|_| is_click) else { return false };
    viewer.execute(Command::Pick([x, y]));
    true
}

/// Shows the mode of the grid under the mouse alone. Returns whether there is one.
fn keep_mode_at(viewer: &mut Viewer, screen: &Screen) -> bool {
    if !viewer.panels.grid.is_on() {
        return false;
    }
    if let Some(mode) = screen.grid_mode_at(screen.mouse.at) {
        viewer.session.settings.mode = mode;
    }
    viewer.panels.grid.end();
    true
}

/// Whether a press of the left button is the second of a double click.
fn is_double_click(mouse: &mut Mouse) -> bool {
    let (now, at) = (Instant::now(), mouse.at);
    let is_second =
        |(since, place): (Instant, Vec2)| now.duration_since(since) <= DOUBLE_CLICK && place.distance(at) <= SAME_PLACE;
    let is_double = mouse.last_press.take().is_some_and(is_second);
    mouse.last_press = (!is_double).then_some((now, at));
    is_double
}

/// Moves the camera so that it looks at the surface under the mouse, and orbits around it. Returns whether there is one.
fn focus(viewer: &mut Viewer, screen: &Screen) -> bool {
    let place = screen.mouse_pixel().zip(screen.camera_view());
    place.is_some_and(|(at, view)| viewer.focus(screen.rect.size, at, &view))
}

/// Whether a key is held that makes a press something else than a click.
fn has_modifier(mouse: &Mouse) -> bool {
    mouse.modifiers.alt_key() || mouse.modifiers.shift_key() || mouse.modifiers.control_key()
}

/// A place of the window in pixels of the picture.
fn in_picture(screen: &Screen, at: Vec2) -> [f32; 2] {
    [at.x - screen.rect.at.0 as f32, at.y - screen.rect.at.1 as f32]
}

fn inside(screen: &Screen, at: Vec2) -> bool {
    let (x, y) = (at.x - screen.whole.at.0 as f32, at.y - screen.whole.at.1 as f32);
    (0.0..screen.whole.size.0 as f32).contains(&x) && (0.0..screen.whole.size.1 as f32).contains(&y)
}

fn drag(viewer: &mut Viewer, screen: &Screen, delta: Vec2) -> bool {
    let Some(view) = screen.camera_view() else { return false };
    let settings = &mut viewer.session.settings;
    let (mouse, camera) = (&screen.mouse, &mut settings.camera);
    if mouse.left && mouse.modifiers.alt_key() {
        // A height of the picture is half a turn.
        let rotation = &mut settings.environment.rotation;
        *rotation = (*rotation + 180.0 * delta.x + 180.0).rem_euclid(360.0) - 180.0;
        return true;
    }
    let pans = mouse.middle || (mouse.left && mouse.modifiers.shift_key());
    match (pans, mouse.left, mouse.right) {
        (true, _, _) => CameraController::pan(camera, &view, delta),
        (_, true, _) => CameraController::orbit(camera, &view, delta),
        (_, _, true) => CameraController::look(camera, &view, delta),
        _ => return false,
    }
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
    let digits = [
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
    let PhysicalKey::Code(code) = key else { return None };
    let number = digits.iter().position(|digit| *digit == code).filter(|_| modifiers.control_key())? as u32 + 1;
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
fn shader_key(viewer: &mut Viewer, key: PhysicalKey, pressed: bool) -> bool {
    let PhysicalKey::Code(code) = key else { return false };
    let Some(number) = keys::number(code) else { return false };
    let keys = viewer.playback.keys();
    if pressed {
        keys.press(number)
    } else {
        keys.release(number)
    }
    true
}

fn on_key(viewer: &mut Viewer, key: &Key, modifiers: ModifiersState) -> bool {
    match key {
        Key::Named(NamedKey::F1) => viewer.panels.show_keys ^= true,
        Key::Named(NamedKey::F5) => viewer.execute(Command::Reload),
        Key::Named(NamedKey::F12) => viewer.execute(Command::Screenshot),
        Key::Named(NamedKey::Escape) if viewer.panels.show_keys => viewer.panels.show_keys = false,
        Key::Named(NamedKey::Escape) if viewer.panels.open_gallery.is_open => {
            viewer.panels.open_gallery.is_open = false
        }
        // A click pins a pixel and selects what it shows; Escape takes both back.
        Key::Named(NamedKey::Escape) if viewer.selected != Selected::Nothing || viewer.panels.inspector.is_pinned() => {
            viewer.panels.inspector.unpin();
            viewer.execute(Command::Select(Selected::Nothing));
        }
        Key::Named(NamedKey::Escape) if viewer.panels.grid.is_on() => viewer.panels.grid.end(),
        Key::Named(NamedKey::Escape) => set_mode(&mut viewer.session, 0),
        Key::Named(NamedKey::Home) => viewer.execute(Command::FrameModel),
        Key::Character(text) => {
            let Some(key) = text.chars().next() else { return false };
            return on_character(viewer, key.to_ascii_lowercase(), modifiers);
        }
        _ => return false,
    }
    true
}

/// A key that types a character. While the picture reads keys, Ctrl is what tells it from the picture's.
fn on_character(viewer: &mut Viewer, key: char, modifiers: ModifiersState) -> bool {
    let (control, shift) = (modifiers.control_key(), modifiers.shift_key());
    let is_ignored = control && !viewer.reads_keys();
    let session = &mut viewer.session;
    match key {
        'p' if control => viewer.panels.palette.toggle(),
        'k' if control => {
            let with = if viewer.compare.is_on() { CompareWith::Nothing } else { CompareWith::ThisPicture };
            viewer.execute(Command::Compare(with));
        }
        'h' if control => viewer.execute(Command::HideSelected),
        'h' if modifiers.alt_key() => viewer.execute(Command::ShowAll),
        'o' if control => viewer.execute(Command::Choose(Dialog::File)),
        'q' if control => viewer.execute(Command::Quit),
        'z' if control => viewer.execute(if shift { Command::Redo } else { Command::Undo }),
        'y' if control => viewer.execute(Command::Redo),
        _ if is_ignored => return false,
        '/' => viewer.execute(Command::IsolateSelected),
        '?' => viewer.panels.show_keys ^= true,
        '[' => step_mode(session, -1),
        ']' => step_mode(session, 1),
        'h' => viewer.panels.visible = !viewer.panels.visible,
        'r' => viewer.execute(Command::FrameModel),
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

fn step_mode(session: &mut Session, step: isize) {
    let Some(shaders) = &session.shaders else { return };
    let count = shaders.modes.len() as isize;
    let at = shaders.modes.iter().position(|mode| mode.slug == session.settings.mode).unwrap_or(0) as isize;
    if count > 0 {
        set_mode(session, (at + step).rem_euclid(count) as usize);
    }
}
