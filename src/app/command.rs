//! Commands of keys, panels and dropped files to the viewer: everything that is not a setting.

use std::path::PathBuf;

use super::editor::Place;
use super::state::arrangement::Panel;
use super::state::dialog::Dialog;
use super::state::exercise::LearnCommand;
use super::state::inspection::Page;
use super::state::selection::Selected;
use super::state::workspace::PanelRequest;
use crate::control::Request;
use crate::file_kind::FileKind;
use crate::settings::Settings;
use crate::shader::Source;
use crate::shader::rewrite::Edit;

/// Reference that the picture is compared with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum CompareWith {
    Nothing,
    /// The picture as it is now, with all its settings.
    ThisPicture,
    /// A version of the shaders, by its number.
    Version(u64),
    /// A picture from a file.
    File(PathBuf),
    /// The picture of another shader tree.
    Tree(PathBuf),
}

/// A side of the model, as in Blender: glTF models face +Z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Front,
    Back,
    Right,
    Left,
    Top,
    Bottom,
}

impl Side {
    pub(super) const ALL: [Self; 6] = [Self::Front, Self::Back, Self::Right, Self::Left, Self::Top, Self::Bottom];

    /// Its name, and its key.
    pub(super) fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Front => ("front", "Numpad 1"),
            Self::Back => ("back", "Ctrl+Numpad 1"),
            Self::Right => ("right", "Numpad 3"),
            Self::Left => ("left", "Ctrl+Numpad 3"),
            Self::Top => ("top", "Numpad 7"),
            Self::Bottom => ("bottom", "Ctrl+Numpad 7"),
        }
    }

    /// Azimuth and elevation of a camera there, degrees.
    pub(super) fn angles(self) -> [f32; 2] {
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

/// A command to the viewer.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Command {
    /// Compile everything again.
    Reload,
    /// Take these settings: a panel has changed its copy.
    Settings(Box<Settings>),
    /// Ask for a change of the panels.
    Panels(PanelRequest),
    /// Show or hide the map of the difference.
    ToggleDifference,
    /// Forget the pixel that the inspector reads.
    Unpin,
    /// Whether the inspector reads the pixel under the mouse.
    FollowMouse(bool),
    /// Hide the diagnostics until the next reload.
    HideDiagnostics,
    /// Hide the kept messages and the warnings of the model.
    HideWarnings,
    /// Never show the hint of the first start again.
    DismissHint,
    /// Offer the last session no longer.
    RefuseSession,
    /// Whether the driver is asked about its code.
    AskDriver(bool),
    /// End the capture with this number.
    CancelCapture(u64),
    /// Take the last change of a setting back.
    Undo,
    /// Take the last undo back.
    Redo,
    /// Move the camera so that it sees the whole model.
    FrameModel,
    /// Frame the model, seen from this side.
    ViewFrom(Side),
    /// Keep the camera under this number.
    KeepCamera(u32),
    /// Go back to the camera that was kept under this number.
    RecallCamera(u32),
    /// Write the picture to `specula-N.png`.
    Screenshot,
    /// Inspect this pixel of the picture, counted from its upper left corner, and select what it shows: the user has clicked it.
    Pick([u32; 2]),
    /// Select a part of the scene.
    Select(Selected),
    /// Hide what is selected.
    HideSelected,
    /// Draw nothing but what is selected; again: everything.
    IsolateSelected,
    /// Draw everything that is hidden or not isolated.
    ShowAll,
    /// Open a panel, or show its tab.
    OpenPanel(Panel),
    /// Open the inspector at a page.
    OpenInspector(Page),
    /// Look through a camera of the model.
    LookThrough(usize),
    /// Switch the rectangular light on and select it.
    PlaceRectangle,
    /// Close the window.
    Quit,
    /// Show a message for a few seconds.
    Say(String),
    /// Show the picture beside another one.
    Compare(CompareWith),
    /// Show a version of the shaders in place of the newest, or none.
    ShowVersion(Option<u64>),
    /// Write the texts of a version of the shaders over the files of the tree.
    WriteVersion(u64),
    /// Show the picture with these numbers in the texts, without a change of the files; none goes back to the files.
    Draft(Vec<Edit>),
    /// Write values into the files.
    WriteEdits(Vec<Edit>),
    /// Open a file or folder in the user's editor.
    Edit(Place),
    /// Let the user choose a file or folder to open.
    Choose(Dialog),
    /// Write the built-in shaders to this folder, or to one that the user chooses, and open them.
    NewTree(Option<PathBuf>),
    /// Run a command of the exercise panel.
    Learn(LearnCommand),
    /// Open a shader tree.
    OpenTree(PathBuf),
    /// Open a model.
    OpenModel(PathBuf),
    /// Open an environment.
    OpenEnvironment(PathBuf),
    /// Take the settings of a look file, or of a PNG that Specula has written.
    OpenLook(PathBuf),
    /// Show what can be opened, with pictures.
    ShowGallery,
    /// Go on with the last session of the working directory.
    RestoreSession,
    /// Whether later windows go on with the last session by themselves.
    RestoreAlways(bool),
    /// Open a measured BRDF and show it.
    OpenMeasured(PathBuf),
    /// Do what a command from outside would do.
    Ask(Box<Request>),
    /// End all captures that are under way.
    CancelCaptures,
}

/// The command that opens a dropped file or folder.
///
/// # Errors
/// A message, if the window cannot open this kind of file.
pub(super) fn open_as(path: PathBuf) -> Result<Command, String> {
    match FileKind::of(&path) {
        FileKind::ShaderTree => Ok(Command::OpenTree(path)),
        FileKind::Model => Ok(Command::OpenModel(path)),
        FileKind::Environment => Ok(Command::OpenEnvironment(path)),
        FileKind::Measured => Ok(Command::OpenMeasured(path)),
        FileKind::Folder => Err(format!(
            "{} is no Specula shader tree: it has no interface.glsl. `specula new DIR` writes one",
            path.display()
        )),
        FileKind::Shader if Source::is_file(&path) => Ok(Command::OpenTree(path)),
        FileKind::Look => Ok(Command::OpenLook(path)),
        FileKind::Shader | FileKind::Other => Err(format!(
            "{}: expected a .gltf or .glb model, an .hdr or .exr environment, a measured .binary or .bin, a look file (.toml or \
             a .png that Specula wrote), or a folder with a shader tree",
            path.display()
        )),
    }
}
