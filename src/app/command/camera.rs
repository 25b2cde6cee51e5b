//! Commands that move the camera.

use serde::Deserialize;
use serde_json::{Value, json};
use winit::keyboard::{ModifiersState, NamedKey};

use super::about::Group;
use super::settings::adopt;
use super::shortcut::Shortcut;
use super::spec::{Outcome, Spec, Until};
use crate::app::actions::select::look_through;
use crate::app::control::short;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::message::did_you_mean;

/// A side of the model, as in Blender: glTF models face +Z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum ViewSide {
    Front,
    Back,
    Right,
    Left,
    Top,
    Bottom,
}

impl ViewSide {
    /// All sides, in the order of their shortcuts.
    pub(in crate::app) const ALL: [Self; 6] =
        [Self::Front, Self::Back, Self::Right, Self::Left, Self::Top, Self::Bottom];

    pub(in crate::app) fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
            Self::Right => "right",
            Self::Left => "left",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }

    /// Name of its key.
    pub(in crate::app) fn key(self) -> String {
        SIDES[self as usize].text()
    }

    /// Azimuth and elevation of a camera there, degrees.
    fn angles(self) -> [f32; 2] {
        match self {
            Self::Front => [0.0, 0.0],
            Self::Back => [180.0, 0.0],
            Self::Right => [90.0, 0.0],
            Self::Left => [-90.0, 0.0],
            Self::Top => [0.0, 90.0],
            Self::Bottom => [0.0, -90.0],
        }
    }
}

/// Fields of `camera`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct CameraFields {
    eye: Option<[f32; 3]>,
    target: Option<[f32; 3]>,
    fovy: Option<f32>,
    azimuth: Option<f32>,
    elevation: Option<f32>,
    frame: bool,
    view: Option<String>,
}

pub(in crate::app) static CAMERA: Spec<CameraFields> = Spec::new("camera", move_camera).takes(
    r#""eye"?: [x,y,z], "target"?: [x,y,z], "fovy"?: deg, "azimuth"?: deg, "elevation"?: deg, "frame"?: true, "view"?: "front""#,
    "Moves the camera; azimuth, elevation, frame and view frame the model. Result: eye, target, fovy",
);

pub(in crate::app) static FRAME: Spec<()> = Spec::plain("frame", |state, _, ()| state.frame_model())
    .label("Frame the model", "camera")
    .shortcuts(Group::Camera, &[Shortcut::key('r'), Shortcut::named(NamedKey::Home)], "frame the model");

const SIDES: [Shortcut; 6] = [
    Shortcut::numpad(1),
    Shortcut::numpad(1).ctrl(),
    Shortcut::numpad(3),
    Shortcut::numpad(3).ctrl(),
    Shortcut::numpad(7),
    Shortcut::numpad(7).ctrl(),
];

/// Frames the model, seen from a side.
pub(in crate::app) static VIEW_FROM: Spec<ViewSide> = Spec::act("view-from", |state, _, side: ViewSide| {
    state.frame_model();
    let camera = &mut state.session.settings.camera;
    [camera.azimuth, camera.elevation] = side.angles();
})
.arguments(|index| ViewSide::ALL[index])
.shortcuts(Group::Camera, &SIDES, "view from the front, the right or the top; with Ctrl, from the opposite side")
.keys("Numpad 1, 3, 7");

/// Saves the camera under a number.
pub(in crate::app) static KEEP_CAMERA: Spec<u32> = Spec::act("keep-camera", |state, _, number: u32| {
    let settings = &mut state.session.settings;
    settings.bookmarks.insert(number.to_string(), settings.camera.clone());
    state.say(format!("Saved this camera as {number}. Ctrl+{number} returns to it"));
})
.arguments(|index| index as u32 + 1)
.shortcuts(
    Group::Camera,
    &const { Shortcut::digits(ModifiersState::CONTROL.union(ModifiersState::SHIFT)) },
    "save this camera under a number",
)
.keys("Ctrl+Shift+1 … 9");

/// Goes back to the camera that was saved under a number.
pub(in crate::app) static RECALL_CAMERA: Spec<u32> = Spec::act("recall-camera", |state, _, number: u32| {
    match state.session.settings.bookmarks.get(&number.to_string()).cloned() {
        Some(camera) => state.session.settings.camera = camera,
        None => state.say(format!("No camera is saved as {number}. Ctrl+Shift+{number} saves the current one")),
    }
})
.arguments(|index| index as u32 + 1)
.shortcuts(Group::Camera, &const { Shortcut::digits(ModifiersState::CONTROL) }, "return to the camera with this number")
.keys("Ctrl+1 … 9");

/// Looks through a camera of the model.
pub(in crate::app) static LOOK_THROUGH: Spec<usize> =
    Spec::act("look-through", |state, _, camera: usize| look_through(state, camera));

fn move_camera(state: &mut State, _: &mut Engine, asked: CameraFields) -> Outcome {
    let mut settings = state.session.settings.clone();
    let camera = &mut settings.camera;
    let frames = asked.frame || asked.view.is_some() || asked.azimuth.is_some() || asked.elevation.is_some();
    if frames {
        camera.frame_model();
    }
    if let Some(name) = &asked.view {
        let names = || ViewSide::ALL.into_iter().map(ViewSide::name);
        let side = ViewSide::ALL.into_iter().find(|side| side.name().eq_ignore_ascii_case(name));
        let unknown = || {
            format!(
                "no view is named `{name}`.{} It can be {}",
                did_you_mean(name, names()),
                names().collect::<Vec<_>>().join(", ")
            )
        };
        [camera.azimuth, camera.elevation] = side.ok_or_else(unknown)?.angles();
    }
    camera.eye = asked.eye.or(camera.eye);
    camera.target = asked.target.or(camera.target);
    if let Some(fovy) = asked.fovy {
        // A camera of the file would override the field of view.
        camera.name.clear();
        camera.fovy = fovy;
    }
    camera.azimuth = asked.azimuth.unwrap_or(camera.azimuth);
    camera.elevation = asked.elevation.unwrap_or(camera.elevation);
    adopt(state, settings)?;
    Ok(Until::Settled(camera_json))
}

/// The camera of the picture.
fn camera_json(state: &State) -> Value {
    state.shown().map_or(Value::Null, |state| {
        let camera = &state.camera;
        let (eye, target) = (short(camera.eye.to_array()), short(camera.target.to_array()));
        json!({ "eye": eye, "target": target, "fovy": short(camera.fovy_rad.to_degrees()) })
    })
}
