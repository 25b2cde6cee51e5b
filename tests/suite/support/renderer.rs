//! Renderers of the embedded tree. The tests of a process share them, so that each pipeline and each light is made once for many tests.

use std::ops::{Deref, DerefMut};
use std::sync::Mutex;

use specula::headless::{Headless, HeadlessError, Sequence};
use specula::render::Capture;
use specula::scene::Model;
use specula::settings::Settings;
use specula::shader::Source;

use super::device::{DEVICES, gpu, number};
use super::{assert_validated, compiler, explain};

/// Renderers of each device that no test holds.
static IDLE: [Mutex<Vec<Headless>>; DEVICES] = [const { Mutex::new(Vec::new()) }; DEVICES];

/// A renderer of the embedded tree that a test holds. The test may change everything but the tree.
pub struct Renderer(Option<Headless>);

impl Deref for Renderer {
    type Target = Headless;

    fn deref(&self) -> &Headless {
        self.0.as_ref().unwrap()
    }
}

impl DerefMut for Renderer {
    fn deref_mut(&mut self) -> &mut Headless {
        self.0.as_mut().unwrap()
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        // A failed test may leave anything behind.
        if !std::thread::panicking() {
            IDLE[number()].lock().unwrap().extend(self.0.take());
        }
    }
}

/// Opens the embedded tree; nothing is written to disk.
pub fn renderer(model: Model, settings: Settings, size: (u32, u32)) -> Renderer {
    let idle = IDLE[number()].lock().unwrap().pop();
    let opened = match idle {
        Some(headless) => reopened(headless, model, settings, size),
        None => {
            Headless::new(gpu(), compiler(), Source::embedded(), model, settings, size).map(|(headless, _)| headless)
        }
    };
    Renderer(Some(opened.unwrap_or_else(explain)))
}

/// A renderer after another test, as if it were new.
fn reopened(
    mut headless: Headless,
    model: Model,
    settings: Settings,
    size: (u32, u32),
) -> Result<Headless, HeadlessError> {
    headless.set_size(size)?;
    headless.set_linear(false);
    headless.set_sequence(Sequence::default());
    *headless.settings_mut() = settings;
    headless.set_model(model)?;
    headless.check_settings()?;
    headless.provide()?;
    Ok(headless)
}

/// A frame of a mode.
pub fn render(headless: &mut Headless, slug: &str) -> Capture {
    headless.settings_mut().mode = slug.to_owned();
    let capture = headless.render().unwrap_or_else(explain);
    assert_validated();
    capture
}
