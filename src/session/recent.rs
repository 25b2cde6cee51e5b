//! The settings and pictures of the last frames, so that a frame without a change makes nothing anew.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::frame::{Clock, FrameInputs, FrameState, Revisions};
use crate::settings::Settings;
use crate::shader::ShaderSet;

/// As many as pictures that a window shows at once: modes side by side, and an earlier version.
const MOST: usize = 10;
/// The newest shaders, and those of an earlier version or a second tree.
const MOST_SHADERS: usize = 2;

/// The inputs and states of the last frames.
#[derive(Clone, Default)]
pub(super) struct Recent {
    pub(super) settings: RecentSettings,
    pub(super) pictures: RecentPictures,
}

/// The settings of the last frames, the newest first.
#[derive(Clone, Default)]
pub(super) struct RecentSettings(VecDeque<Arc<Settings>>);

impl RecentSettings {
    /// These settings: the known ones if they are equal.
    pub(super) fn shared(&mut self, settings: &Settings) -> Arc<Settings> {
        let known = self.0.iter().position(|known| **known == *settings).and_then(|at| self.0.remove(at));
        let shared = known.unwrap_or_else(|| Arc::new(settings.clone()));
        self.0.truncate(MOST - 1);
        self.0.push_front(shared.clone());
        shared
    }
}

/// A picture with the inputs that it does not hold.
#[derive(Clone)]
struct Picture {
    settings: Arc<Settings>,
    revisions: Revisions,
    clock: Clock,
    state: Arc<FrameState>,
}

impl Picture {
    /// Whether the inputs give the same picture, apart from camera, directions of orbiting lights, time and size.
    fn has_needs_of(&self, settings: &Arc<Settings>, inputs: &FrameInputs<'_>) -> bool {
        let state = &*self.state;
        Arc::ptr_eq(&state.shaders, inputs.shaders)
            && (self.revisions, state.pipelines.target) == (inputs.revisions, inputs.target)
            && (Arc::ptr_eq(&self.settings, settings) || self.settings.is_alike(settings))
            && state.scene.as_ref() == inputs.scene
    }
}

/// The pictures of the last frames, the newest first.
#[derive(Clone, Default)]
pub(super) struct RecentPictures(VecDeque<Picture>);

impl RecentPictures {
    /// The picture of these inputs. A known one is returned if it is the same; if it differs only in what needs no other resources,
    /// these are taken from it. `settings` are those of the inputs.
    pub(super) fn state(&mut self, settings: &Arc<Settings>, inputs: &FrameInputs<'_>) -> Arc<FrameState> {
        let known = self.0.iter().position(|known| known.has_needs_of(settings, inputs));
        let FrameInputs { revisions, clock, size, .. } = *inputs;
        let is_same = |known: &Picture| {
            Arc::ptr_eq(&known.settings, settings) && (known.clock, known.state.size) == (clock, size)
        };
        let state = match known.and_then(|at| self.0.remove(at)) {
            Some(known) if is_same(&known) => known.state,
            Some(known) => Arc::new(known.state.moved(settings, clock, size)),
            None => {
                self.make_room(inputs.shaders);
                Arc::new(FrameState::new(inputs))
            }
        };
        self.0.push_front(Picture { settings: settings.clone(), revisions, clock, state: state.clone() });
        state
    }

    /// Forgets the oldest pictures before one of these shaders is added.
    fn make_room(&mut self, shaders: &Arc<ShaderSet>) {
        self.0.truncate(MOST - 1);
        let mut known = vec![shaders.clone()];
        self.0.retain(|picture| {
            let of = &picture.state.shaders;
            if !known.iter().any(|known| Arc::ptr_eq(known, of)) {
                known.push(of.clone());
            }
            known.len() <= MOST_SHADERS
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::TargetFormat;
    use crate::session::Session;

    fn state(session: &Session) -> Arc<FrameState> {
        session.frame_state(Clock::default(), (64, 48), TargetFormat::half(1)).unwrap()
    }

    /// The same picture, made of nothing that is known.
    fn anew(session: &Session) -> FrameState {
        let shaders = session.shaders.as_ref().unwrap();
        FrameState::new(&session.inputs(shaders, None, Clock::default(), (64, 48), TargetFormat::half(1)))
    }

    #[test]
    fn nothing_is_made_twice() {
        let mut session = Session::new(Settings::default());
        session.shaders = Some(Arc::default());
        let first = state(&session);
        assert!(Arc::ptr_eq(&first, &state(&session)));
        assert!(Arc::ptr_eq(&session.shared_settings(), &session.shared_settings()));

        session.settings.camera.azimuth += 10.0;
        let moved = state(&session);
        assert!(moved.is_same(&anew(&session)) && !moved.is_same(&first));
        assert!(Arc::ptr_eq(&moved.pipelines, &first.pipelines) && Arc::ptr_eq(&moved.tables, &first.tables));

        session.settings.environment.name = "none".into();
        let dark = state(&session);
        assert!(dark.is_same(&anew(&session)) && !Arc::ptr_eq(&dark.pipelines, &first.pipelines));
        session.revisions.environment += 1;
        session.settings.environment.name = "sky".into();
        assert!(state(&session).is_same(&anew(&session)));
    }

    #[test]
    fn as_many_pictures_are_known_as_lie_side_by_side() {
        let mut session = Session::new(Settings::default());
        session.shaders = Some(Arc::default());
        let mut of_mode = |mode: usize| {
            session.settings.mode = mode.to_string();
            state(&session)
        };
        let first: Vec<_> = (0..MOST).map(&mut of_mode).collect();
        for (mode, known) in first.iter().enumerate() {
            assert!(Arc::ptr_eq(known, &of_mode(mode)), "{mode}");
        }
    }
}
