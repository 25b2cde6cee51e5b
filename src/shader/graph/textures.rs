//! The textures that a tree declares: finds their image files and reads the bytes.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;

use crate::shader::annotation::texture::TextureDesc;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::source::pattern::{FACES, Pattern};
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{SourceError, TreePath};

/// The kind of an image, by the sampler that reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TextureKind {
    /// `sampler2D`: one picture.
    Flat,
    /// `samplerCube`: six faces.
    Cube,
    /// `sampler3D`: slices of a volume.
    Volume,
    /// `sampler2DArray`: layers.
    Array,
}

impl TextureKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Flat, Self::Cube, Self::Volume, Self::Array];

    /// The sampler in GLSL.
    pub fn glsl(self) -> &'static str {
        match self {
            Self::Flat => "sampler2D",
            Self::Cube => "samplerCube",
            Self::Volume => "sampler3D",
            Self::Array => "sampler2DArray",
        }
    }

    /// The kind that a sampler in GLSL reads. `None` for samplers without such textures.
    pub fn of(glsl: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.glsl() == glsl)
    }
}

/// A file of a texture.
#[derive(Clone, PartialEq, Eq)]
pub struct TextureFile {
    /// Path for messages.
    pub path: String,
    /// Its content.
    pub bytes: Arc<[u8]>,
}

/// An image file of the tree that stages sample.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    /// The kind that a stage declares. A texture that is declared as several kinds is several textures.
    pub kind: TextureKind,
    /// Its files, at least one: with a `*` six faces in the order +X -X +Y -Y +Z -Z, or all layers or slices.
    pub files: Vec<TextureFile>,
    /// The parsed `//@texture`.
    pub desc: TextureDesc,
}

impl Texture {
    /// Whether its only file is a color lookup table.
    pub fn is_table(&self) -> bool {
        is_table(&self.desc)
    }
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Texture").field("name", &self.desc.name).field("kind", &self.kind).finish_non_exhaustive()
    }
}

fn is_table(desc: &TextureDesc) -> bool {
    desc.image.rsplit_once('.').is_some_and(|(_, extension)| extension.eq_ignore_ascii_case("cube"))
}

/// Finds and reads the files of a texture.
///
/// # Errors
/// The annotation does not fit the kind, or a file does not exist, cannot be read, or lies outside of the tree: at the line of
/// the annotation.
pub(super) fn read_texture(
    desc: &TextureDesc,
    kind: TextureKind,
    snapshot: &Snapshot<'_>,
) -> Result<Texture, Box<Diagnostic>> {
    let refuse = |message: String| Box::new(desc.place.error_at(&desc.image, message));
    if let Some((message, help)) = contradiction(desc, kind) {
        let word = if desc.layers.is_some() { "layers=" } else { desc.image.as_str() };
        return Err(Box::new(desc.place.error_at(word, message).with_help(help)));
    }
    let beside = TreePath::from(desc.declared_in.as_str()).sibling(&desc.image);
    let mut candidates: Vec<TreePath> = beside.into_iter().chain(TreePath::parse(&desc.image)).collect();
    candidates.dedup();
    if candidates.is_empty() {
        return Err(refuse(format!("\"{}\" leaves the shader tree; images must stay inside its root", desc.image)));
    }
    let paths = match Pattern::of(&desc.image) {
        None => candidates.clone(),
        Some(pattern) if kind == TextureKind::Cube => faces(desc, pattern, &candidates, snapshot).map_err(refuse)?,
        Some(pattern) => parts(desc, pattern, &candidates, snapshot).map_err(refuse)?,
    };
    let is_pattern = Pattern::of(&desc.image).is_some();
    let read = |path: &TreePath| {
        let shown = snapshot.display_path(path);
        match snapshot.source().read_bytes(path) {
            Ok(bytes) => Some(Ok(TextureFile { path: shown, bytes: bytes.into() })),
            Err(SourceError::Missing) if !is_pattern => None,
            Err(error) => Some(Err(refuse(format!("{shown} {error}")))),
        }
    };
    // Without a `*`, the paths are alternatives for the same file.
    let most = if is_pattern { paths.len() } else { 1 };
    let files: Vec<TextureFile> = paths.iter().filter_map(read).take(most).collect::<Result<_, _>>()?;
    if files.is_empty() {
        return Err(refuse(format!("\"{}\" not found; looked for {}", desc.image, snapshot.looked_for(&candidates))));
    }
    Ok(Texture { kind, files, desc: desc.clone() })
}

/// A message and a help text if the options of an annotation do not fit the kind of the texture.
fn contradiction(desc: &TextureDesc, kind: TextureKind) -> Option<(String, String)> {
    let (name, glsl) = (&desc.name, kind.glsl());
    let stars = desc.image.matches('*').count();
    let told = |message: String, help: &str| Some((message, help.to_owned()));
    if stars > 1 || (stars == 1 && Pattern::of(&desc.image).is_none()) {
        let message = format!("\"{}\": expected one `*`, in the name of the file", desc.image);
        return told(message, "the name of a folder is written out");
    }
    let several = [desc.layers.map(|count| format!("layers={count}")), (stars == 1).then(|| "a `*`".to_owned())];
    let several: Vec<String> = several.into_iter().flatten().collect();
    match (kind, several.as_slice()) {
        (TextureKind::Flat, [what, ..]) => told(
            format!("`{name}` has {what}, but it is declared as sampler2D, which reads one picture"),
            "declare it as sampler2DArray, sampler3D or, for six faces, samplerCube",
        ),
        (TextureKind::Cube, [what, ..]) if desc.layers.is_some() => told(
            format!("`{name}` has {what}, but it is declared as samplerCube, which has six faces"),
            "name six files with a `*`, or one file that holds all faces",
        ),
        (_, [_, _]) => told(
            format!("`{name}` has layers= and a `*`"),
            "use layers= for one file that holds all of them, or a `*` for a file each",
        ),
        (TextureKind::Volume, [what]) if is_table(desc) => {
            told(format!("`{name}` has {what}, but a .cube file has a size of its own"), "leave that out")
        }
        (TextureKind::Cube | TextureKind::Array, _) if is_table(desc) => told(
            format!("`{name}` is declared as {glsl}, but a .cube file is a table of colors"),
            "declare it as sampler3D, or as sampler2D, which sees its slices side by side",
        ),
        (TextureKind::Array, []) => told(
            format!("`{name}` is declared as sampler2DArray, but nothing says how many layers it has"),
            "add layers=8 for one file that holds all of them, or name a file each with a `*`",
        ),
        _ => None,
    }
}

/// The files that match a pattern, by the text in place of the `*`.
fn matching(pattern: Pattern<'_>, path: &TreePath, snapshot: &Snapshot<'_>) -> BTreeMap<String, TreePath> {
    let folder = path.as_str().rsplit_once('/').map_or("", |(folder, _)| folder);
    let names = snapshot.source().folder(folder);
    let found = names.iter().filter_map(|name| {
        let part = pattern.part(name)?;
        Some((part.to_owned(), path.sibling(name)?))
    });
    found.collect()
}

/// The six faces of a cube map. The first complete set of names counts.
fn faces(
    desc: &TextureDesc,
    pattern: Pattern<'_>,
    candidates: &[TreePath],
    snapshot: &Snapshot<'_>,
) -> Result<Vec<TreePath>, String> {
    let folders: Vec<_> = candidates.iter().map(|path| matching(pattern, path, snapshot)).collect();
    // The set with the most existing files; of equal ones the first.
    let mut best: (Vec<TreePath>, [&str; 6]) = (Vec::new(), FACES[0]);
    for found in &folders {
        for set in FACES {
            let paths: Vec<TreePath> = set.iter().filter_map(|part| found.get(*part).cloned()).collect();
            if paths.len() > best.0.len() {
                best = (paths, set);
            }
        }
    }
    let (paths, set) = best;
    if paths.len() == set.len() {
        return Ok(paths);
    }
    let looked = snapshot.looked_for(candidates);
    if paths.is_empty() {
        let sets: Vec<String> = FACES[..3].iter().map(|set| set.join(" ")).collect();
        let sets = sets.join(", or ");
        return Err(format!(
            "no face of \"{}\" found; looked for {looked} with {sets} in place of the `*`",
            desc.image
        ));
    }
    let is_there = |part: &str| folders.iter().any(|found| found.get(part).is_some_and(|path| paths.contains(path)));
    let missing: Vec<String> = set.iter().filter(|part| !is_there(part)).map(|part| pattern.with(part)).collect();
    Err(format!("\"{}\" has no {}; expected the six faces {}", desc.image, missing.join(", no "), set.join(" ")))
}

/// The files of layers or slices, sorted by the text in place of the `*`: numbers by value, then others alphabetically.
fn parts(
    desc: &TextureDesc,
    pattern: Pattern<'_>,
    candidates: &[TreePath],
    snapshot: &Snapshot<'_>,
) -> Result<Vec<TreePath>, String> {
    let found = candidates.iter().map(|path| matching(pattern, path, snapshot)).find(|found| !found.is_empty());
    let Some(found) = found else {
        return Err(format!("no file matches \"{}\"; looked for {}", desc.image, snapshot.looked_for(candidates)));
    };
    let mut found: Vec<(String, TreePath)> = found.into_iter().collect();
    found.sort_by_cached_key(|(part, _)| {
        let number: Option<u64> = part.parse().ok();
        (number.is_none(), number, part.clone())
    });
    Ok(found.into_iter().map(|(_, path)| path).collect())
}
