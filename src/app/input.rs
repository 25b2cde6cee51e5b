//! Keys and mouse. What egui does not want is the picture's.

use glam::{Vec2, Vec3};
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::keyboard::{Key, KeyCode, ModifiersState, NamedKey, PhysicalKey};

use crate::settings::LightSettings;

use super::camera::CameraHand;
use super::document::Document;
use super::screen::Screen;

/// The mouse over the picture.
#[derive(Default)]
pub(super) struct Mouse {
    /// Pixels of the window.
    pub(super) at: Vec2,
    /// Whether it is over the picture, and not over a panel.
    pub(super) over: bool,
    left: bool,
    middle: bool,
    right: bool,
    modifiers: ModifiersState,
}

/// Takes an event; returns whether the picture changes.
pub(super) fn on_window_event(document: &mut Document, event: &WindowEvent, screen: &Screen, taken: bool) -> bool {
    match event {
        WindowEvent::ModifiersChanged(modifiers) => {
            document.mouse.modifiers = modifiers.state();
            false
        }
        WindowEvent::KeyboardInput { event, .. } => {
            let pressed = event.state == ElementState::Pressed;
            if let PhysicalKey::Code(code) = event.physical_key
                && fly_key(document, code, pressed && document.mouse.right)
            {
                return true;
            }
            let steps = matches!(&event.logical_key, Key::Character(text) if text == "[" || text == "]");
            pressed && !taken && (steps || !event.repeat) && on_key(document, &event.logical_key)
        }
        WindowEvent::MouseInput { state, button, .. } => {
            let pressed = *state == ElementState::Pressed && !taken && inside(screen, document.mouse.at);
            match button {
                MouseButton::Left => document.mouse.left = pressed,
                MouseButton::Middle => document.mouse.middle = pressed,
                MouseButton::Right => {
                    document.mouse.right = pressed;
                    document.hand.fly = Vec3::ZERO;
                }
                _ => {}
            }
            false
        }
        WindowEvent::CursorMoved { position, .. } => {
            let at = Vec2::new(position.x as f32, position.y as f32);
            let delta = (at - document.mouse.at) / screen.rect.height.max(1) as f32;
            let was_over = std::mem::replace(&mut document.mouse.over, inside(screen, at));
            document.mouse.at = at;
            drag(document, screen, delta) || was_over || document.mouse.over
        }
        WindowEvent::CursorLeft { .. } => std::mem::take(&mut document.mouse.over),
        WindowEvent::MouseWheel { delta, .. } if !taken && inside(screen, document.mouse.at) => {
            let steps = match delta {
                MouseScrollDelta::LineDelta(_, lines) => *lines,
                MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
            };
            let Some(view) = &screen.view else { return false };
            CameraHand::dolly(&mut document.settings.camera, view, steps);
            true
        }
        _ => false,
    }
}

fn inside(screen: &Screen, at: Vec2) -> bool {
    let (x, y) = (at.x - screen.rect.x as f32, at.y - screen.rect.y as f32);
    (0.0..screen.rect.width as f32).contains(&x) && (0.0..screen.rect.height as f32).contains(&y)
}

fn drag(document: &mut Document, screen: &Screen, delta: Vec2) -> bool {
    let Some(view) = &screen.view else { return false };
    let (mouse, camera) = (&document.mouse, &mut document.settings.camera);
    let pans = mouse.middle || (mouse.left && mouse.modifiers.shift_key());
    match (pans, mouse.left, mouse.right) {
        (true, _, _) => CameraHand::pan(camera, view, delta),
        (_, true, _) => CameraHand::orbit(camera, view, delta),
        (_, _, true) => CameraHand::look(camera, view, delta),
        _ => return false,
    }
    true
}

/// W A S D E Q while the right button is held. A release always counts, so that no key sticks.
fn fly_key(document: &mut Document, code: KeyCode, pressed: bool) -> bool {
    let (axis, sign) = match code {
        KeyCode::KeyD => (0, 1.0),
        KeyCode::KeyA => (0, -1.0),
        KeyCode::KeyE => (1, 1.0),
        KeyCode::KeyQ => (1, -1.0),
        KeyCode::KeyW => (2, 1.0),
        KeyCode::KeyS => (2, -1.0),
        _ => return false,
    };
    let fly = &mut document.hand.fly;
    if pressed {
        fly[axis] = sign;
    } else if fly[axis] == sign {
        fly[axis] = 0.0;
    }
    pressed
}

fn on_key(document: &mut Document, key: &Key) -> bool {
    match key {
        Key::Named(NamedKey::F5) => document.reload(),
        Key::Named(NamedKey::F12) => document.screenshot = true,
        Key::Named(NamedKey::Escape) => set_mode(document, 0),
        Key::Named(NamedKey::Home) => document.frame_model(),
        Key::Character(text) => {
            let Some(key) = text.chars().next() else { return false };
            return on_character(document, key);
        }
        _ => return false,
    }
    true
}

fn on_character(document: &mut Document, key: char) -> bool {
    let control = document.mouse.modifiers.control_key();
    match key.to_ascii_lowercase() {
        'q' if control => document.quit = true,
        _ if control => return false,
        '[' => step_mode(document, -1),
        ']' => step_mode(document, 1),
        'h' => document.show_ui = !document.show_ui,
        'r' => document.frame_model(),
        'l' => {
            let lights = &mut document.settings.lights;
            lights.spin = if lights.spin == 0.0 { 30.0 } else { LightSettings::default().spin };
        }
        digit @ '1'..='9' => set_mode(document, digit as usize - '1' as usize),
        '0' => set_mode(document, 9),
        letter => {
            let slug = document.shaders().and_then(|s| s.modes.iter().find(|m| m.key == Some(letter)));
            let Some(slug) = slug.map(|m| m.slug.clone()) else { return false };
            // The same key again goes back to the picture.
            let again = slug == document.settings.mode;
            document.settings.mode = if again { "final".into() } else { slug };
        }
    }
    true
}

fn set_mode(document: &mut Document, index: usize) {
    if let Some(mode) = document.shaders().and_then(|s| s.modes.get(index)) {
        document.settings.mode = mode.slug.clone();
    }
}

fn step_mode(document: &mut Document, step: isize) {
    let Some(shaders) = document.shaders() else { return };
    let count = shaders.modes.len() as isize;
    let at = shaders.modes.iter().position(|m| m.slug == document.settings.mode).unwrap_or(0) as isize;
    if count > 0 {
        set_mode(document, (at + step).rem_euclid(count) as usize);
    }
}
