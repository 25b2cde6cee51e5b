//! Events that wait for a frame. egui takes all keys of a frame at once. A key behind one that moves the keyboard's focus (a click,
//! Enter, Escape, Tab, the key of the palette) would still go where the focus was before: to a palette that is closed by now, say. A mouse
//! button that is pressed and released within a frame drags nothing, nor does it move a slider.

use egui::{Event, Key};
use winit::event::{ElementState, WindowEvent};

use super::Interface;

impl Interface {
    /// Defers a key or the release of a mouse button until after the next frame if egui has yet to process one that moves the focus, or a
    /// button of the mouse, and all events that follow it. Returns an event that need not wait.
    pub(in crate::app) fn wait(&mut self, event: WindowEvent) -> Option<WindowEvent> {
        let waits = match &event {
            WindowEvent::KeyboardInput { .. }
            | WindowEvent::Ime(_)
            | WindowEvent::ModifiersChanged(_)
            | WindowEvent::MouseInput { state: ElementState::Released, .. } => {
                !self.waiting.is_empty() || self.has_to_wait(&event)
            }
            WindowEvent::MouseInput { .. }
            | WindowEvent::MouseWheel { .. }
            | WindowEvent::CursorMoved { .. }
            | WindowEvent::CursorEntered { .. }
            | WindowEvent::CursorLeft { .. }
            | WindowEvent::Focused(_) => !self.waiting.is_empty(),
            _ => false,
        };
        if !waits {
            return Some(event);
        }
        // A held key repeats faster than slow frames come, and must not continue after its release.
        if !matches!(&event, WindowEvent::KeyboardInput { event, .. } if event.repeat) {
            self.waiting.push_back(event);
        }
        None
    }

    /// The next deferred event that can be handled.
    pub(in crate::app) fn next_waiting(&mut self) -> Option<WindowEvent> {
        let next = self.waiting.front()?;
        if self.has_to_wait(next) { None } else { self.waiting.pop_front() }
    }

    /// Whether an event has to wait for the next frame. A frame knows only which keys are down at its end, so `Ctrl` stays down until a frame
    /// has seen the click that it belongs to.
    fn has_to_wait(&self, event: &WindowEvent) -> bool {
        let is_key = matches!(event, WindowEvent::KeyboardInput { .. } | WindowEvent::ModifiersChanged(_));
        let is_button = |event: &Event| matches!(event, Event::PointerButton { .. });
        self.moves_focus() || (is_key && self.input.egui_input().events.iter().any(is_button))
    }

    /// Whether the events that egui processes with the next frame move the keyboard focus.
    fn moves_focus(&self) -> bool {
        let moves = |event: &Event| match event {
            Event::PointerButton { pressed, .. } => *pressed,
            Event::Key { key: Key::Enter | Key::Escape | Key::Tab, pressed, .. } => *pressed,
            Event::Key { key: Key::P, pressed, modifiers, .. } => *pressed && modifiers.command,
            _ => false,
        };
        self.input.egui_input().events.iter().any(moves)
    }
}
