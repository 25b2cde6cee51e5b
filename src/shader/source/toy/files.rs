//! The files beside a toy that belong to it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::adapt::{COMMON, named_files};
use super::drawing::BUFFERS;
use super::{Toy, opened_path};
use crate::shader::glsl::includes;
use crate::shader::source::TreePath;
use crate::shader::source::pattern::{FACES, Pattern};
use crate::shader::source::read::names_in;

impl Toy {
    /// The files whose change changes the tree. Some may not exist yet.
    pub fn watched(&self) -> Vec<PathBuf> {
        let mut names: Vec<String> = self.candidates(COMMON).into();
        names.extend(BUFFERS.iter().flat_map(|buffer| self.candidates(buffer)));
        for drawing in self.drawings() {
            names.extend(named_files(&drawing.text).iter().flat_map(|file| self.files_of(file)));
            names.push(drawing.file);
        }
        names.push(self.name());
        names.sort();
        names.dedup();
        names.iter().map(|name| self.folder().join(name)).collect()
    }

    /// The file of the toy to which a buffer or shared code belongs, if it is beside it: `image.glsl` for `buffer_a.glsl`, `t.glsl` for
    /// `t.buffer_a.glsl`.
    pub fn whole(path: &Path) -> Option<PathBuf> {
        let name = path.file_stem()?.to_str()?;
        let part = name.rsplit('.').next()?.to_ascii_lowercase().replace(' ', "_");
        if part != COMMON && !BUFFERS.contains(&part.as_str()) {
            return None;
        }
        let stems: &[&str] = match name.rsplit_once('.') {
            Some((stem, _)) => &[stem],
            None => &["image", "Image"],
        };
        let ending = path.extension()?.to_str()?;
        let mut files = stems.iter().map(|stem| path.with_file_name(format!("{stem}.{ending}")));
        files.find(|file| Self::is_toy(file) && file.is_file())
    }

    /// The files that a name with a `*` stands for: those that exist, and the faces of a cube map, which may not exist yet.
    fn files_of(&self, name: &str) -> Vec<String> {
        let Some(pattern) = Pattern::of(name) else { return vec![name.to_owned()] };
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
        let faces = FACES.iter().flatten().map(|part| pattern.with(part));
        let found = names_in(&self.folder().join(folder)).into_iter().filter(|name| pattern.part(name).is_some());
        let place = |name: String| if folder.is_empty() { name } else { format!("{folder}/{name}") };
        faces.chain(found).map(place).collect()
    }

    /// Candidate names for the file of a buffer, or of the shared code, starting with one for this toy alone. `Buffer A.glsl` is
    /// Shadertoy's own name for `buffer_a.glsl`.
    fn candidates(&self, name: &str) -> [String; 3] {
        let words = name.split('_').map(|word| word[..1].to_ascii_uppercase() + &word[1..]);
        let words: Vec<String> = words.collect();
        [format!("{}.{name}.glsl", self.stem()), format!("{name}.glsl"), format!("{}.glsl", words.join(" "))]
    }

    /// The file of this name beside the toy, and its text.
    pub(super) fn beside(&self, name: &str) -> Option<(String, String)> {
        self.candidates(name).into_iter().filter(|file| *file != self.name()).find_map(|file| {
            let text = self.text(&file).ok()?;
            Some((file, text))
        })
    }

    /// The file that all drawings share, and its text.
    pub(super) fn common(&self) -> Option<(String, String)> {
        self.beside(COMMON)
    }

    /// The files with code on disk, the opened one first: those that draw, the shared one, and what they include.
    pub fn own_files(&self) -> Vec<TreePath> {
        let drawings = self.drawings();
        let own = drawings.iter().map(|drawing| (drawing.file.as_str(), drawing.text.as_str()));
        let common = self.common();
        let common = common.iter().map(|(file, text)| (file.as_str(), text.as_str()));
        let mut beside: Vec<TreePath> =
            self.with_includes(own.chain(common)).into_iter().map(|(path, _)| path).collect();
        beside.sort();
        beside.dedup();
        let opened = TreePath::from(self.name().as_str());
        let beside = beside.into_iter().filter(|path| *path != opened).map(|path| opened_path(path.as_str()));
        [self.opened()].into_iter().chain(beside).collect()
    }

    /// The texts of files and of what they include.
    pub(super) fn texts<'a>(&self, files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Vec<String> {
        self.with_includes(files).into_iter().map(|(_, text)| text).collect()
    }

    /// Files below the folder of the toy and what they include, with their texts.
    fn with_includes<'a>(&self, files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Vec<(TreePath, String)> {
        let mut open: Vec<(TreePath, String)> =
            files.into_iter().map(|(file, text)| (TreePath::from(file), text.to_owned())).collect();
        let (mut out, mut seen): (Vec<_>, BTreeSet<TreePath>) = Default::default();
        while let Some((path, text)) = open.pop() {
            for name in includes(&text).map(|include| include.name) {
                let places = path.sibling(name).into_iter().chain(TreePath::parse(name));
                let found = places.filter_map(|place| Some((self.text(place.as_str()).ok()?, place)));
                let found = { found }.next().filter(|(_, place)| seen.insert(place.clone()));
                open.extend(found.map(|(text, place)| (place, text)));
            }
            out.push((path, text));
        }
        out
    }
}
