//! Keys and mouse. Events that egui does not consume control the camera, the modes and the viewer. While the picture reads keys,
//! those that type a character go to its shaders instead.

pub(super) mod keyboard;

use std::time::{Duration, Instant};

use glam::{Vec2, Vec3};
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};

use super::interface::Interface;
use super::mouse::Mouse;
use super::screen::Screen;
use crate::app::actions::compare::hold_reference;
use crate::app::actions::select::focus;
use crate::app::command::execute;
use crate::app::command::scene::CLICK;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::frame::BEYOND;
use crate::scene::CameraController;
use keyboard::on_keyboard;

/// Most time between the presses of a double click.
const DOUBLE_CLICK: Duration = Duration::from_millis(400);
/// Most pixels between them.
const SAME_PLACE: f32 = 4.0;

/// Handles an event, unless egui has consumed it (`taken`). Returns whether to redraw.
pub(super) fn on_window_event(
    state: &mut State,
    engine: &mut Engine,
    event: &WindowEvent,
    (interface, screen): (&mut Interface, &Screen),
    taken: bool,
) -> bool {
    match event {
        WindowEvent::ModifiersChanged(modifiers) => {
            interface.mouse.modifiers = modifiers.state();
            false
        }
        WindowEvent::KeyboardInput { event, is_synthetic, .. } => {
            // A double click is two presses with nothing in between.
            interface.mouse.last_press = interface.mouse.last_press.filter(|_| event.state != ElementState::Pressed);
            on_keyboard(state, engine, interface, event, *is_synthetic, taken)
        }
        WindowEvent::Focused(false) => {
            state.playback.keys().release_all();
            state.playback.release_buttons();
            hold_reference(state, false) || state.reads_keys()
        }
        WindowEvent::MouseInput { state: press, button, .. } => {
            let pressed = *press == ElementState::Pressed && !taken && inside(screen, interface.mouse.at);
            if let Some(bit) = button_bit(*button) {
                state.playback.set_button(bit, pressed);
            }
            match button {
                MouseButton::Left => return on_left_button(state, engine, (interface, screen), pressed),
                MouseButton::Middle => interface.mouse.middle = pressed,
                MouseButton::Right => {
                    interface.mouse.right = pressed;
                    interface.camera.fly = Vec3::ZERO;
                }
                _ => {}
            }
            false
        }
        WindowEvent::CursorMoved { position, .. } => {
            on_cursor_moved(state, interface, screen, Vec2::new(position.x as f32, position.y as f32))
        }
        WindowEvent::CursorLeft { .. } => {
            state.playback.hover(BEYOND);
            std::mem::take(&mut interface.mouse.over)
        }
        WindowEvent::MouseWheel { delta, .. } if !taken && inside(screen, interface.mouse.at) => {
            let steps = match delta {
                MouseScrollDelta::LineDelta(_, lines) => *lines,
                MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
            };
            let Some(view) = screen.camera_now(&state.session) else { return false };
            CameraController::dolly(&mut state.session.settings.camera, &view, steps);
            true
        }
        _ => false,
    }
}

/// Moves the mouse to `at`, in pixels of the window: what it drags, and what shaders know of it. Returns whether to redraw.
fn on_cursor_moved(state: &mut State, interface: &mut Interface, screen: &Screen, at: Vec2) -> bool {
    let delta = (at - interface.mouse.at) / screen.rect.size.1.max(1) as f32;
    let is_over = inside(screen, at);
    let was_over = std::mem::replace(&mut interface.mouse.over, is_over);
    interface.mouse.at = at;
    let [x, y] = in_picture(screen, at);
    let (width, height) = screen.rect.size;
    let is_inside = is_over && x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32;
    state.playback.hover(if is_inside { [x, y] } else { BEYOND });
    interface.mouse.click = interface.mouse.click.filter(|start| start.distance(at) <= SAME_PLACE);
    if interface.mouse.left {
        state.playback.drag([x, y]);
    }
    drag(state, interface, screen, delta) || was_over || interface.mouse.over
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
fn on_left_button(
    state: &mut State,
    engine: &mut Engine,
    (interface, screen): (&mut Interface, &Screen),
    pressed: bool,
) -> bool {
    let was = std::mem::replace(&mut interface.mouse.left, pressed);
    let is_double = pressed && is_double_click(&mut interface.mouse);
    let place = interface.mouse.at;
    let clicked = interface.mouse.click.take().filter(|start| start.distance(place) <= SAME_PLACE);
    interface.mouse.click = (pressed && !is_double && !has_modifier(&interface.mouse)).then_some(place);
    match pressed {
        true => state.playback.press(in_picture(screen, interface.mouse.at)),
        false if was => state.playback.release(),
        false => {}
    }
    if is_double {
        return focus_at_mouse(state, interface, screen);
    }
    let is_click = clicked.is_some() && was && !pressed;
    if is_click && keep_mode_at(state, interface, screen) {
        return true;
    }
    let Some((x, y)) = screen.pixel_at(interface.mouse.at).filter(|_| is_click) else { return false };
    execute(state, engine, CLICK.with([x, y]));
    true
}

/// Shows the mode of the grid under the mouse alone. Returns whether there is one.
fn keep_mode_at(state: &mut State, interface: &Interface, screen: &Screen) -> bool {
    if !state.grid.is_on() {
        return false;
    }
    if let Some(mode) = screen.grid_mode_at(interface.mouse.at) {
        state.session.settings.mode = mode;
    }
    state.grid.end();
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
fn focus_at_mouse(state: &mut State, interface: &Interface, screen: &Screen) -> bool {
    let place = screen.pixel_at(interface.mouse.at).zip(screen.camera_view());
    place.is_some_and(|(at, view)| focus(state, screen.rect.size, at, &view))
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

fn drag(state: &mut State, interface: &Interface, screen: &Screen, delta: Vec2) -> bool {
    let Some(view) = screen.camera_now(&state.session) else { return false };
    let settings = &mut state.session.settings;
    let (mouse, camera) = (&interface.mouse, &mut settings.camera);
    let modifiers = mouse.modifiers;
    let turns = mouse.middle && !modifiers.shift_key()
        || mouse.left && !modifiers.control_key() && (modifiers.alt_key() || modifiers.shift_key());
    if turns {
        // A height of the picture is half a turn.
        let rotation = &mut settings.environment.rotation;
        *rotation = (*rotation + 180.0 * delta.x + 180.0).rem_euclid(360.0) - 180.0;
        return true;
    }
    let pans = mouse.middle || (mouse.left && modifiers.control_key());
    match (pans, mouse.left, mouse.right) {
        (true, _, _) => CameraController::pan(camera, &view, delta),
        (_, true, _) => CameraController::orbit(camera, &view, delta),
        (_, _, true) => CameraController::look(camera, &view, delta),
        _ => return false,
    }
    true
}
