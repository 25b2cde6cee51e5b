//! Takes what the baker has made.

use crate::app::engine::Engine;
use crate::app::messages::reloads::on_endless_loop;
use crate::app::state::State;
use crate::app::state::recent::Kind;
use crate::events::{Event, emit};
use crate::gpu::GpuError;
use crate::render::{BakeError, wrong_values};
use crate::scene::environment;
use crate::threads::BakeMessage;
use std::path::Path;
use std::sync::Arc;

pub(in crate::app) fn on_bake(state: &mut State, engine: &mut Engine, message: BakeMessage) {
    match message {
        BakeMessage::Progress(number, done, next) => engine.threads.baker.set_progress(number, done, next),
        BakeMessage::Environment(number, result) => {
            let Some(key) = engine.threads.baker.ended(number) else { return };
            // A command that waits may be about another environment.
            let is_chosen = state.session.settings.environment.name == key.name;
            state.opened.end_environment(&key.name, result.is_ok(), &mut state.session.settings);
            match result {
                // The shaders are others, and do the same.
                Ok(environment) if Arc::ptr_eq(&environment, engine.resources.environment()) => {
                    engine.resources.set_environment(key, Some(environment));
                }
                Ok(environment) => {
                    environment.report.warnings.iter().for_each(|warning| state.say(warning.as_str()));
                    warn_of(state, environment.wrong());
                    if !environment::is_word_of_specula(&key.name) {
                        state.recent.remember(Kind::Environment, Path::new(&key.name));
                    }
                    emit(&state.events, &Event::Bake(&environment.report));
                    state.session.revisions.suns = environment.sun_count();
                    engine.resources.set_environment(key, Some(environment));
                }
                Err(error) => {
                    if let BakeError::Gpu(GpuError::EndlessLoop(words)) = error {
                        on_endless_loop(state, engine, words);
                    }
                    state.recent.forget(Kind::Environment, Path::new(&key.name));
                    engine.resources.set_environment(key, None);
                    if is_chosen {
                        state.waiting.fail(&error.to_string());
                    }
                    state.say(format!("{error}\nThe previous environment stays."));
                }
            }
        }
        BakeMessage::Tables(key, result) => {
            if engine.threads.baker.has_tables(&key) {
                if let Ok(tables) = &result {
                    warn_of(state, tables.wrong.iter().copied());
                }
                if let Err(GpuError::EndlessLoop(words)) = result {
                    on_endless_loop(state, engine, words);
                }
                let result = result.map_err(|error| state.say(error.to_string()));
                engine.resources.set_tables(key, result.ok());
            }
        }
        BakeMessage::Measured(key, result) => {
            if engine.threads.baker.has_read(&key) {
                let is_chosen = Path::new(&state.session.settings.measured) == key.path;
                state.opened.end_measured(&key.path, result.is_ok(), &mut state.session.settings);
                let result = result.map_err(|message| {
                    if is_chosen {
                        state.waiting.fail(&message);
                    }
                    state.say(message);
                });
                engine.resources.set_measured(key, result.ok());
            }
        }
        BakeMessage::PathTracing(key, result) => {
            if engine.threads.baker.has_path_tracing(&key) {
                let result = result.map_err(|message| {
                    state.waiting.fail(&message);
                    state.say(message);
                });
                engine.resources.set_path_tracing(key, result.ok());
            }
        }
    }
}

/// Warns of functions whose values a bake could not use.
fn warn_of(state: &mut State, functions: impl IntoIterator<Item = &'static str>) {
    for function in functions {
        state.say(wrong_values(function));
    }
}
