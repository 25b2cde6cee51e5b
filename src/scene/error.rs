//! Errors of loading a model, with messages for the person who opened it.

use std::path::PathBuf;
use std::sync::Arc;

/// The remedy for a file that violates the specification.
pub(super) const EXPORT_AGAIN: &str = "Export the model again, or run it through the Khronos glTF validator.";
/// The remedy for a path that leaves the model's folder.
const ALLOW_OUTSIDE: &str = "Give --allow-outside to read it if you trust this model.";
/// The remedy for a URI that is never opened.
const SAVE_BESIDE: &str = "Save that file beside the model and name it by its relative path.";
/// The remedy for a file that is not there.
const PUT_THERE: &str = "Put it there or export a self-contained .glb.";

/// A model that could not be loaded. The message is one paragraph: the file, what was expected, what was found, and what
/// to do.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", file.display())]
pub struct LoadError {
    /// The file as the user gave it, or the name of a built-in model.
    pub file: PathBuf,
    /// The fault.
    pub problem: Box<Problem>,
    /// Absolute paths of all files that were read or looked for, the model's own first. Watch these to notice a repair.
    /// Empty for a model in memory.
    pub files: Vec<PathBuf>,
}

/// A fault of a model.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The file itself cannot be read.
    #[error("cannot be read: {0}. Check the path and that the file may be read.")]
    Read(#[source] std::io::Error),
    /// The file has no bytes.
    #[error("is empty. Expected a glTF 2.0 file (.gltf or .glb); copy or export it again.")]
    Empty,
    /// A zip archive, or a file in it, cannot be read.
    #[error("cannot be read as a zip archive: {0}. Unpack it and open the model inside, or pack it again.")]
    Archive(String),
    /// A folder or archive without a model.
    #[error("has no .gltf or .glb file in it. Export the model as glTF 2.0.")]
    NoModel,
    /// A folder or archive with several models, none of them nearest to its root.
    #[error("has {count} models; open one of them: {names}.")]
    SeveralModels {
        /// Their number.
        count: usize,
        /// The paths of the first ones, separated by commas.
        names: String,
    },
    /// Neither JSON nor GLB.
    #[error(
        "is not a glTF file: expected JSON text or a binary that begins with `glTF`, found {found}. \
         Convert the model to glTF 2.0 (.gltf or .glb), for example with Blender's export."
    )]
    NotGltf {
        /// The kind of file that the first bytes suggest.
        found: String,
    },
    /// The GLB container is damaged.
    #[error(
        "is a damaged GLB: expected {expected}, found {found}. The file may be cut short: copy or export it again."
    )]
    Container {
        /// Required here by the GLB specification.
        expected: String,
        /// Found in the file instead.
        found: String,
    },
    /// The JSON does not parse, or is not glTF.
    #[error("has JSON that does not parse as glTF 2.0: {0}. Export the model again, or correct the line named here.")]
    Json(#[source] gltf::json::Error),
    /// Another major version.
    #[error(
        "needs glTF {found}, expected 2.0. Convert the model to glTF 2.0 (for example with Blender or gltf-pipeline)."
    )]
    Version {
        /// `asset.version` or `asset.minVersion`.
        found: String,
    },
    /// `extensionsRequired` names extensions that Specula does not support.
    #[error(
        "requires {names}, which Specula does not support, so it would not look as its author meant. \
         Export it without {pronoun} (supported: {supported})."
    )]
    Extensions {
        /// The unsupported extensions, separated by commas.
        names: String,
        /// "it" or "them".
        pronoun: &'static str,
        /// The supported extensions, separated by commas.
        supported: String,
    },
    /// The file violates the specification.
    #[error("is invalid at {place}: expected {expected}, found {found}. {}", EXPORT_AGAIN)]
    Invalid {
        /// The object, as a path into the JSON with its name.
        place: String,
        /// Required by glTF.
        expected: String,
        /// Found in the file.
        found: String,
    },
    /// A URI with a scheme that is never opened.
    #[error(
        "names `{uri}` at {place}: expected a file beside the model or a data: URI, found the scheme `{scheme}:`, \
         which is never opened. {}",
        SAVE_BESIDE
    )]
    Scheme {
        /// The object.
        place: String,
        /// The URI, shortened.
        uri: String,
        /// Its scheme.
        scheme: String,
    },
    /// A path that leaves the model's folder.
    #[error("names `{uri}` at {place}: expected a file in the model's folder, found {found}. {}", ALLOW_OUTSIDE)]
    Outside {
        /// The object.
        place: String,
        /// The URI, decoded.
        uri: String,
        /// How the path leaves the folder: by its text, or through a link.
        found: String,
    },
    /// A file that the model names cannot be read.
    #[error(
        "needs the file {}, named at {place}, which cannot be read: {source}. {}",
        path.display(),
        PUT_THERE
    )]
    External {
        /// The object.
        place: String,
        /// The resolved path.
        path: PathBuf,
        /// Why it cannot be read.
        source: std::io::Error,
    },
    /// Data in a buffer that could not be loaded or decoded.
    #[error("{0}")]
    Unreadable(Arc<Problem>),
    /// The scene has no mesh.
    #[error(
        "has nothing to draw: expected a scene with at least one mesh, found {found}. \
         Check what was selected when it was exported."
    )]
    NothingToDraw {
        /// Found in the file.
        found: String,
    },
    /// The result is no longer needed.
    #[error("is no longer needed: the load was canceled.")]
    Canceled,
    /// The loader or a decoder panicked.
    #[error(
        "was refused: the loader stopped at something it did not expect ({found}). \
         The file is most likely invalid; please report it with the file."
    )]
    Refused {
        /// The panic's message.
        found: String,
    },
}

impl Problem {
    /// Shorthand for [`Problem::Invalid`].
    pub(super) fn invalid(place: impl Into<String>, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::Invalid { place: place.into(), expected: expected.into(), found: found.into() }
    }

    /// The fault alone, as part of a sentence.
    pub(super) fn reason(&self) -> String {
        match self {
            Self::Invalid { place, expected, found } => format!("{place}: expected {expected}, found {found}"),
            Self::Scheme { place, uri, scheme } => {
                format!("{place} names `{uri}`, and the scheme `{scheme}:` is never opened")
            }
            Self::Outside { place, uri, found } => {
                format!("{place} names `{uri}`: expected a file in the model's folder, found {found}")
            }
            Self::External { place, path, source } => {
                format!("{place} needs the file {}, which cannot be read ({source})", path.display())
            }
            Self::Unreadable(problem) => problem.reason(),
            other => other.to_string(),
        }
    }

    /// The remedy, if the fault is not one of the file's own content.
    pub(super) fn remedy(&self) -> Option<&'static str> {
        match self {
            Self::Scheme { .. } => Some(SAVE_BESIDE),
            Self::Outside { .. } => Some(ALLOW_OUTSIDE),
            Self::External { .. } => Some(PUT_THERE),
            Self::Unreadable(problem) => problem.remedy(),
            _ => None,
        }
    }
}
