//! Selection, visibility of nodes, and the camera that the user looks through.

use std::sync::Arc;

use super::Viewer;
use crate::app::state::selection::{LightId, Selected, name_or};
use crate::app::state::workspace::PanelRequest;
use crate::events::{Event, SelectedEvent, emit};
use crate::scene::{CameraController, CameraView, Model, pick};
use crate::settings::LightSource;

impl Viewer {
    /// Selects what a pixel of the picture on screen shows, or nothing, also if that is selected already.
    pub(super) fn select_at(&mut self, [x, y]: [u32; 2]) {
        let Some(state) = self.shown().filter(|state| state.pipelines.draws_model) else { return };
        let Some(scene) = state.scene.clone() else { return };
        let hit = pick(scene.model(), &state.camera, state.size, (x, y), |instance| scene.sides(instance));
        self.select(self.selected.clicked(hit.map(|hit| hit.instance)));
        self.workspace.request(PanelRequest::FollowSelection);
    }

    /// Selects a part of the scene, and prints an event.
    pub(in crate::app) fn select(&mut self, selected: Selected) {
        if std::mem::replace(&mut self.selected, selected) == selected {
            return;
        }
        let event = self.selected_event();
        event.into_iter().for_each(|event| emit(&self.events, &Event::Selected(event)));
    }

    /// The selection by its names; `None` without a model.
    pub(in crate::app) fn selected_event(&self) -> Option<SelectedEvent> {
        let selected = self.selected;
        let scene = self.session.scene()?;
        let model = scene.model();
        let instance = match selected {
            Selected::Instance(instance) => model.instances.get(instance),
            _ => None,
        };
        let node = match selected {
            Selected::Node(node) => model.nodes.get(node),
            _ => instance.and_then(|instance| model.nodes.get(model.node_of(instance)?)),
        };
        let material = selected.material(&scene).map(|material| model.material_key(material));
        Some(SelectedEvent {
            instance: match selected {
                Selected::Instance(index) => instance.map(|_| index),
                _ => None,
            },
            node: node.map(|node| name_or(&node.name, || format!("#{}", node.index))),
            primitive: instance.map(|instance| model.primitives[instance.primitive].name.clone()),
            material,
        })
    }

    /// Whether each instance of the scene on screen is selected; empty if none is.
    pub(in crate::app) fn selected_instances(&mut self) -> Arc<[bool]> {
        let scene = self.shown().and_then(|state| state.scene.clone());
        let (Some(scene), true) = (scene, self.selected != Selected::Nothing) else {
            self.selected_cache = None;
            return Arc::default();
        };
        if let Some((selected, of, instances)) = &self.selected_cache
            && (*selected, of) == (self.selected, &scene)
        {
            return instances.clone();
        }
        let is_in = self.selected.is_in(scene.model());
        let instances = if is_in { self.selected.instances(&scene) } else { Vec::new() };
        let instances: Arc<[bool]> = if instances.contains(&true) { instances.into() } else { Arc::default() };
        self.selected_cache = Some((self.selected, scene, instances.clone()));
        instances
    }

    /// The name of what is selected, for the settings that hide and isolate. Says what to do if there is none.
    fn selected_key(&mut self) -> Option<String> {
        let model = self.session.model().cloned()?;
        let key = self.selected.key(&model);
        if key.is_none() {
            self.say("Select a node or a primitive first: click it in the picture or in the Scene panel");
        }
        key
    }

    /// Hides what is selected.
    pub(super) fn hide_selected(&mut self) {
        let Some(key) = self.selected_key() else { return };
        let scene = &mut self.session.settings.scene;
        scene.isolated.retain(|name| *name != key);
        if !scene.hidden.contains(&key) {
            scene.hidden.push(key);
        }
        self.select(Selected::Nothing);
    }

    /// Isolates what is selected, or shows everything if it is isolated already.
    pub(super) fn isolate_selected(&mut self) {
        if !self.session.settings.scene.isolated.is_empty() {
            self.session.settings.scene.isolated.clear();
            return;
        }
        let Some(key) = self.selected_key() else { return };
        let scene = &mut self.session.settings.scene;
        scene.hidden.retain(|name| *name != key);
        scene.isolated = vec![key];
    }

    /// Shows everything again.
    pub(super) fn show_all(&mut self) {
        let scene = &mut self.session.settings.scene;
        scene.hidden.clear();
        scene.isolated.clear();
    }

    /// Looks through a camera of the model.
    pub(super) fn look_through(&mut self, camera: usize) {
        let Some(model) = self.session.model().filter(|model| camera < model.cameras.len()) else { return };
        let name = model.camera_key(camera);
        let settings = &mut self.session.settings.camera;
        settings.frame_model();
        settings.name = name;
    }

    /// Switches the rectangular light on and selects it.
    pub(super) fn place_rectangle(&mut self) {
        let lights = &mut self.session.settings.lights;
        lights.rect.enabled = true;
        if lights.source == LightSource::None {
            lights.source = LightSource::Orbit;
        }
        self.select(Selected::Light(LightId::Rectangle));
    }

    /// Switches on the lights of a new model's file, or the orbiting ones if it has none, as long as the user has not chosen a source of
    /// lights. A file that has lights was made to be seen in them, and other viewers show them too.
    pub(super) fn follow_lights(&mut self, model: &Model) {
        let lights = &mut self.session.settings.lights;
        // The user has chosen others since.
        self.follows_lights &= lights.source == self.followed_source;
        if !self.follows_lights {
            return;
        }
        let count = model.lights.len();
        let source = if count > 0 { LightSource::Model } else { LightSource::default() };
        (lights.source, self.followed_source) = (source, source);
        if count > 0 {
            let lights = if count == 1 { "light".to_owned() } else { format!("{count} lights") };
            self.say(format!(
                "Using the {lights} of the model's file instead of the orbiting lights (Lights > Source)"
            ));
        }
    }

    /// Moves the camera so that it looks at the surface at a pixel, and orbits around it. Returns whether there is one.
    pub(in crate::app) fn focus(&mut self, size: (u32, u32), at: (u32, u32), view: &CameraView) -> bool {
        let Some(scene) = self.session.scene() else { return false };
        let hit = pick(scene.model(), view, size, at, |instance| scene.sides(instance));
        let Some(hit) = hit else { return false };
        CameraController::focus(&mut self.session.settings.camera, view, hit.point);
        true
    }
}
