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
    /// Whether the inputs give the same picture, apart from camera, directions of orbiting lights, pose, time and size.
    fn has_needs_of(&self, settings: &Arc<Settings>, inputs: &FrameInputs<'_>) -> bool {
        let state = &*self.state;
        Arc::ptr_eq(&state.shaders, inputs.shaders)
            && (self.revisions, state.pipelines.target) == (inputs.revisions, inputs.target)
            && (Arc::ptr_eq(&self.settings, settings) || self.settings.is_alike(settings))
            && match (&state.scene, inputs.scene) {
                (Some(known), Some(scene)) => known.has_same_draws(scene),
                (known, scene) => known.is_none() && scene.is_none(),
            }
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
    use crate::scene::{Model, load_bytes};
    use crate::session::Session;
    use crate::settings::ModelSettings;

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

    /// A triangle that moves from 0 to 2 along X in a second, again and again.
    fn moving() -> Model {
        let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAABAAAAAAAAAAAA=";
        let accessor = |offset: u32, kind: &str, count: u32| {
            format!(r#"{{"bufferView":0,"byteOffset":{offset},"componentType":5126,"count":{count},"type":"{kind}"}}"#)
        };
        let accessors = [accessor(0, "VEC3", 3), accessor(36, "SCALAR", 2), accessor(44, "VEC3", 2)].join(",");
        let animation = r#"{"name":"go","samplers":[{"input":1,"output":2}],
            "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}"#;
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"animations":[{animation}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{accessors}],
            "bufferViews":[{{"buffer":0,"byteLength":68}}],
            "buffers":[{{"byteLength":68,"uri":"data:application/octet-stream;base64,{data}"}}]}}"#
        );
        load_bytes("moving", json.as_bytes()).unwrap()
    }

    #[test]
    fn an_animation_moves_the_model_and_nothing_else() {
        let mut session = Session::new(Settings::default());
        session.shaders = Some(Arc::default());
        session.set_model(&Arc::new(moving()));
        let at = |session: &Session, time_s: f32| {
            let clock = Clock { time_s, ..Clock::default() };
            session.frame_state(clock, (64, 48), TargetFormat::half(1)).unwrap()
        };
        let place = |state: &FrameState| {
            let scene = state.scene.as_ref().unwrap();
            assert_eq!(scene.pose().instances[0], scene.model().instances[0].world_from_object);
            scene.pose().instances[0].w_axis.x
        };
        let first = at(&session, 0.0);
        let moved = at(&session, 1.25);
        assert_eq!((place(&first), place(&moved)), (0.0, 0.5), "it begins again after a second");
        assert_eq!(session.scene().unwrap().pose(), moved.scene.as_ref().unwrap().pose(), "panels see the same");
        assert!(!first.is_same(&moved) && at(&session, 1.25).is_same(&moved));
        assert!(Arc::ptr_eq(&first.pipelines, &moved.pipelines), "pipelines stay while it moves");
        assert_eq!(first.camera.eye, moved.camera.eye, "the camera stands still");
        // The frame that is drawn while an edit compiles.
        let clock = Clock { time_s: 0.75, ..Clock::default() };
        assert_eq!(place(&first.moved(&session.settings, clock, (64, 48))), 1.5);
        let is_playing = |session: &Session, time_s: f32| at(session, time_s).scene.as_ref().unwrap().is_playing();
        assert!(is_playing(&session, 5.0));
        for (setting, time_s, expected, plays) in [
            ("animation.speed=-0.5", 0.5, 1.5, true),
            ("animation.time=0.25", 0.25, 0.25, true),
            ("animation.loop=false", 0.25, 0.25, true),
            ("animation.loop=false", 4.0, 0.0, false),
            ("animation.speed=2", 0.25, 1.5, true),
            ("animation.speed=2", 4.0, 2.0, false),
            ("animation.speed=0", 7.0, 0.5, false),
            ("animation.clips=go:0.5", 1.0, 0.25, false),
            ("animation.clips=none", 1.0, 0.0, false),
        ] {
            session.settings.assign(setting).unwrap();
            assert_eq!((place(&at(&session, time_s)), is_playing(&session, time_s)), (expected, plays), "{setting}");
        }
        session.settings.assign("animation.clips=stay").unwrap();
        assert_eq!(session.problems(false).len(), 1);
        assert!(session.problems(false)[0].contains("no animation 'stay': it has go"), "{:?}", session.problems(false));
        let placed = ModelSettings { translation: [10.0, 0.0, 0.0], ..ModelSettings::default() };
        session.settings = Settings { model: placed, ..Settings::default() };
        assert_eq!(place(&at(&session, 0.5)), 11.0);
    }
}
