//! An exercise, as the `exercise.toml` of its folder describes it: one of `assets/learn`, or one of the user's own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use include_dir::{Dir, DirEntry};
use serde::Deserialize;

use super::goal::Goal;
use crate::regular_file;
use crate::settings::Settings;
use crate::shader::{Source, TreePath, embedded};

/// The file that describes an exercise.
pub(super) const DESCRIPTION: &str = "exercise.toml";

/// How hard an exercise is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// A line to change.
    Easy,
    /// Some lines to write.
    Medium,
    /// An equation to derive or a file to write.
    Hard,
}

/// A change of the shipped tree.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    /// Path in the tree.
    file: String,
    /// A text that the shipped file has exactly once.
    find: String,
    /// The text in its place.
    put: String,
}

/// The file to open in the editor.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileToOpen {
    /// Path in the tree.
    pub file: String,
    /// A text in the line to open.
    pub at: String,
}

/// The fields of `exercise.toml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Data {
    title: String,
    level: Level,
    /// The idea that the exercise teaches, in a few words.
    idea: String,
    text: String,
    source: String,
    hints: Vec<String>,
    #[serde(default)]
    model: Option<String>,
    /// Settings of the picture, as `--set` takes them.
    #[serde(default)]
    set: Vec<String>,
    open: FileToOpen,
    /// Edits that put the fault into the shipped tree at the start.
    #[serde(default)]
    fault: Vec<Edit>,
    /// Edits that the solution makes to the shipped tree.
    #[serde(default)]
    solution: Vec<Edit>,
    goal: Vec<Goal>,
}

/// An exercise.
#[derive(Clone, Debug)]
pub struct Exercise {
    /// Its place in the list, from 1; 0 for one of the user's own.
    pub number: usize,
    /// Name of its folder, as `03-fresnel`.
    pub name: String,
    /// The folder of one of the user's own, absolute.
    pub folder: Option<PathBuf>,
    /// Its title.
    pub title: String,
    /// How hard it is.
    pub level: Level,
    /// The idea that the exercise teaches, in a few words.
    pub idea: String,
    /// The explanation: paragraphs, and formulas in lines that begin with four spaces.
    pub text: String,
    /// Where the equation is from: author, year, number.
    pub source: String,
    /// Hints, from a nudge to almost the solution.
    pub hints: Vec<String>,
    /// The built-in model that it shows.
    pub model: String,
    /// The file to open in the editor.
    pub open: FileToOpen,
    /// The goals, all of which must be reached.
    pub goals: Vec<Goal>,
    set: Vec<String>,
    /// The files that differ from the shipped tree, at the start and when it is solved.
    start: Files,
    solved: Files,
}

/// Texts of files by their paths in the tree.
type Files = BTreeMap<TreePath, String>;

impl Exercise {
    /// Reads an exercise that the program embeds.
    ///
    /// # Errors
    /// A message: a file is missing or wrong, or an edit does not fit the shipped tree.
    pub(super) fn embedded(folder: &Dir<'_>) -> Result<Self, String> {
        let name = folder.path().file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let number = name.split('-').next().and_then(|number| number.parse().ok());
        let number = number.ok_or_else(|| format!("exercise {name}: the name does not begin with a number"))?;
        let description = folder.get_file(folder.path().join(DESCRIPTION)).and_then(|file| file.contents_utf8());
        let files = [files(folder, "start"), files(folder, "solution")];
        let read = Self::parse(description.unwrap_or_default(), files);
        read.map(|read| Self { number, name: name.to_owned(), ..read })
            .map_err(|error| format!("exercise {name}: {error}"))
    }

    /// Reads the folder of an exercise of the user's own.
    ///
    /// # Errors
    /// A message: a file is missing or wrong, or an edit does not fit the shipped tree.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let path = folder.join(DESCRIPTION);
        let error = |error: String| format!("{}: {error}", path.display());
        let description = regular_file::read_text(&path).map_err(|e| error(e.to_string()))?;
        let files = ["start", "solution"].map(|part| files_on_disk(&folder.join(part)));
        let read = Self::parse(&description, files).map_err(error)?;
        Ok(Self { name, folder: Some(folder), ..read })
    }

    /// An exercise by its description and the files of its start and its solution. It has no name yet.
    fn parse(description: &str, [mut start, solution]: [Files; 2]) -> Result<Self, String> {
        let data: Data = toml::from_str(description).map_err(|e| e.to_string())?;
        let mut solved = start.clone();
        solved.extend(solution);
        for (edits, texts) in [(&data.fault, &mut start), (&data.solution, &mut solved)] {
            edits.iter().try_for_each(|edit| apply(edit, texts))?;
        }
        // In the solution, a file that the start changes is the shipped one, unless the solution changes it too.
        for path in start.keys() {
            if let Some(shipped) = shipped(path).filter(|_| !solved.contains_key(path)) {
                solved.insert(path.clone(), shipped);
            }
        }
        let Data { title, level, idea, text, source, hints, model, set, open, goal: goals, .. } = data;
        let model = model.unwrap_or_else(|| crate::scene::BUILT_IN[0].to_owned());
        let (number, name, folder) = (0, String::new(), None);
        Ok(Self {
            number,
            name,
            folder,
            title,
            level,
            idea,
            text,
            source,
            hints,
            model,
            open,
            goals,
            set,
            start,
            solved,
        })
    }

    /// Its number, or the name of one of the user's own.
    pub fn label(&self) -> String {
        if self.number > 0 { self.number.to_string() } else { self.name.clone() }
    }

    /// The name without the number, as `fresnel`.
    pub fn slug(&self) -> &str {
        self.name.split_once('-').map_or(&self.name, |(_, slug)| slug)
    }

    /// The settings of its picture, as `--set` takes them.
    pub fn settings(&self) -> &[String] {
        &self.set
    }

    /// Changes settings to those of the exercise's picture.
    ///
    /// # Errors
    /// A message: a setting does not exist.
    pub fn apply_settings(&self, settings: &mut Settings) -> Result<(), String> {
        self.set.iter().try_for_each(|assignment| settings.assign(assignment))
    }

    /// The whole tree at the start.
    pub fn start_tree(&self) -> Source {
        tree(&self.start)
    }

    /// The whole tree when it is solved.
    pub fn solved_tree(&self) -> Source {
        tree(&self.solved)
    }

    /// The files that the solution changes, with their texts at the end.
    pub fn solution(&self) -> impl Iterator<Item = (&TreePath, &str)> {
        let is_changed = |(path, text): &(&TreePath, &String)| self.text_at_start(path).as_ref() != Some(*text);
        self.solved.iter().filter(is_changed).map(|(path, text)| (path, text.as_str()))
    }

    /// The text of a file at the start.
    pub fn text_at_start(&self, path: &TreePath) -> Option<String> {
        self.start.get(path).cloned().or_else(|| shipped(path))
    }

    /// The line to open in a file with this text, from 1.
    pub fn line_to_open(&self, text: &str) -> Option<u32> {
        let line = text.lines().position(|line| line.contains(&self.open.at))?;
        u32::try_from(line + 1).ok()
    }
}

/// The shipped tree with these files in place of its own.
fn tree(files: &Files) -> Source {
    let mut all: Files =
        embedded::list(None).into_iter().filter_map(|path| Some((path.clone(), shipped(&path)?))).collect();
    all.extend(files.clone());
    Source::of_texts(all)
}

fn shipped(path: &TreePath) -> Option<String> {
    String::from_utf8(embedded::read(None, path)?.to_vec()).ok()
}

fn apply(edit: &Edit, texts: &mut Files) -> Result<(), String> {
    let path = TreePath::parse(&edit.file).ok_or_else(|| format!("{} is no path in a tree", edit.file))?;
    let text = texts.get(&path).cloned().or_else(|| shipped(&path));
    let text = text.ok_or_else(|| format!("the tree has no {path}"))?;
    match text.matches(&edit.find).count() {
        1 => _ = texts.insert(path, text.replacen(&edit.find, &edit.put, 1)),
        count => return Err(format!("{path} has `{}` {count} times, expected once", edit.find)),
    }
    Ok(())
}

/// The files below `part` of an exercise's folder, by their paths in the tree.
fn files(folder: &Dir<'_>, part: &str) -> Files {
    let mut found = Files::new();
    let root = folder.path().join(part);
    if let Some(directory) = folder.get_dir(&root) {
        collect(directory, &root, &mut found);
    }
    found
}

fn collect(directory: &Dir<'_>, root: &Path, found: &mut Files) {
    for entry in directory.entries() {
        match entry {
            DirEntry::Dir(directory) => collect(directory, root, found),
            DirEntry::File(file) => {
                let path = file.path().strip_prefix(root).ok().and_then(Path::to_str).and_then(TreePath::parse);
                found.extend(path.zip(file.contents_utf8().map(str::to_owned)));
            }
        }
    }
}

/// The same of a folder on disk.
fn files_on_disk(folder: &Path) -> Files {
    let source = Source::disk(folder);
    let text = |path: &TreePath| String::from_utf8(source.read_bytes(path).ok()?).ok();
    source.list().into_iter().filter_map(|path| Some((path.clone(), text(&path)?))).collect()
}
