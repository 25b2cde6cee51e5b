//! The versions of the shaders that were on screen, with what each changed, what it cost and how it looked.

use std::cell::OnceCell;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use chrono::{DateTime, Local};

use super::difference::{Line, difference};
use crate::events::ReloadEvent;
use crate::shader::ShaderSet;

/// Number of versions that are kept. Each has pipelines, and after an edit of D also the light that was baked with it.
const MOST: usize = 12;
/// Number of trees beside the open one whose versions are kept.
const MOST_TREES: usize = 3;

/// A picture in small.
pub(in crate::app) struct Thumbnail {
    /// Width and height, pixels.
    pub(in crate::app) size: [usize; 2],
    /// sRGB with alpha, row by row.
    pub(in crate::app) rgba8: Vec<u8>,
}

/// One version of the shaders.
pub(in crate::app) struct Version {
    /// Its number among the versions of its tree, from 1. It stays.
    pub(in crate::app) number: u64,
    /// The newest generation with its texts: shaders get another when a version is shown again, or another expression is watched.
    pub(in crate::app) generation: u64,
    /// When it was first on screen.
    pub(in crate::app) since: DateTime<Local>,
    /// The reload that made it.
    pub(in crate::app) reload: ReloadEvent,
    /// Device time of its first frame, milliseconds.
    pub(in crate::app) device_ms: Option<f64>,
    /// Thumbnail of its last picture.
    pub(in crate::app) thumbnail: Option<Arc<Thumbnail>>,
    pub(in crate::app) shaders: Arc<ShaderSet>,
    /// Whether a loop did not end in its picture.
    is_cut_short: bool,
    /// Whether the files have other texts, because numbers are dragged. The next version replaces it.
    is_draft: bool,
    /// The difference of its texts from the previous version.
    difference: OnceCell<Vec<Line>>,
}

impl Version {
    /// The names of the changed files without folders, or "whole tree".
    pub(in crate::app) fn title(&self) -> String {
        let names: Vec<&str> = self.reload.changed.iter().map(|path| path.rsplit('/').next().unwrap_or(path)).collect();
        if names.is_empty() { "whole tree".to_owned() } else { names.join(", ") }
    }

    /// Whether a loop did not end in its picture.
    pub(in crate::app) fn is_cut_short(&self) -> bool {
        self.is_cut_short
    }
}

/// A tree that was open before, with its versions.
struct Aside {
    place: PathBuf,
    tree: usize,
    list: VecDeque<Version>,
}

/// The newest versions of the tree that is open, the oldest first. Those of other trees are kept until these are opened again.
#[derive(Default)]
pub(in crate::app) struct Versions {
    /// Number of the tree: [`ShaderSet::tree`].
    tree: usize,
    list: VecDeque<Version>,
    /// The trees that were open last, the newest first.
    aside: VecDeque<Aside>,
    /// Number of trees that were opened after the first.
    opened: usize,
    /// The shaders of an older version that was shown again. They are on screen for some frames after that has ended.
    again: Option<Arc<ShaderSet>>,
}

impl Versions {
    /// All versions, the oldest first.
    pub(in crate::app) fn iter(&self) -> impl DoubleEndedIterator<Item = &Version> {
        self.list.iter()
    }

    pub(in crate::app) fn get(&self, number: u64) -> Option<&Version> {
        self.list.iter().find(|version| version.number == number)
    }

    /// The version that a generation of the shaders shows.
    pub(in crate::app) fn of_generation(&self, generation: u64) -> Option<&Version> {
        self.list.iter().find(|version| version.generation == generation)
    }

    fn of_generation_mut(&mut self, generation: u64) -> Option<&mut Version> {
        self.list.iter_mut().find(|version| version.generation == generation)
    }

    /// Whether a generation is that of a version that is kept, of this tree or another one.
    pub(in crate::app) fn keeps(&self, generation: u64) -> bool {
        let others = self.aside.iter().flat_map(|of| &of.list);
        self.list.iter().chain(others).any(|version| version.generation == generation)
    }

    /// Sets the versions of the tree at `from` aside, and takes those of the tree at `to` if they are kept. `None`: a tree that is not on
    /// disk. Returns the number of the tree at `to`.
    pub(in crate::app) fn change_tree(&mut self, from: Option<&Path>, to: Option<&Path>) -> usize {
        let list = std::mem::take(&mut self.list);
        if let Some(place) = from.filter(|_| !list.is_empty()) {
            self.aside.push_front(Aside { place: place.to_owned(), tree: self.tree, list });
        }
        let again = self.aside.iter().position(|of| Some(&*of.place) == to).and_then(|index| self.aside.remove(index));
        if let Some(again) = again {
            (self.tree, self.list) = (again.tree, again.list);
        } else {
            self.opened += 1;
            self.tree = self.opened;
        }
        self.aside.truncate(MOST_TREES);
        self.again = None;
        self.tree
    }

    /// Adds the version that has just come on screen.
    pub(in crate::app) fn add(&mut self, shaders: &Arc<ShaderSet>, reload: ReloadEvent, is_draft: bool) {
        let generation = shaders.generation;
        let draft = self.list.pop_back_if(|last| last.is_draft);
        // Watching another expression, and going back to the newest version, create none; the sources are unchanged.
        if let Some(last) = self.list.back_mut().filter(|last| has_same_texts(&last.shaders, shaders)) {
            (last.generation, last.shaders) = (generation, shaders.clone());
            return;
        }
        self.list.push_back(Version {
            // Memory that runs short takes older versions, not their numbers.
            number: self.list.back().map(|last| last.number + 1).or(draft.map(|draft| draft.number)).unwrap_or(1),
            generation,
            since: Local::now(),
            reload,
            device_ms: None,
            thumbnail: None,
            shaders: shaders.clone(),
            is_cut_short: false,
            is_draft,
            difference: OnceCell::new(),
        });
        self.list.drain(..self.list.len().saturating_sub(MOST));
    }

    /// Takes the shaders with the stages that were compiled later.
    pub(in crate::app) fn complete(&mut self, shaders: &Arc<ShaderSet>) {
        if let Some(version) = self.of_generation_mut(shaders.generation) {
            version.shaders = shaders.clone();
        }
    }

    /// Records the times of a version's first frame. Those of the first frame with another watched expression do not count.
    pub(in crate::app) fn time(&mut self, generation: u64, first_frame_ms: f64, device_ms: Option<f64>) {
        if let Some(version) = self.of_generation_mut(generation).filter(|version| version.reload.first_frame_ms == 0.0)
        {
            (version.reload.first_frame_ms, version.device_ms) = (first_frame_ms, device_ms);
        }
    }

    /// Keeps the newest version although its numbers were dragged: they are in the files now.
    pub(in crate::app) fn keep_draft(&mut self) {
        if let Some(last) = self.list.back_mut() {
            last.is_draft = false;
        }
    }

    /// Takes the thumbnail of a version.
    pub(in crate::app) fn set_thumbnail(&mut self, generation: u64, thumbnail: Thumbnail) {
        if let Some(version) = self.of_generation_mut(generation) {
            version.thumbnail = Some(Arc::new(thumbnail));
        }
    }

    /// Marks a version in which a loop did not end. It is not drawn again, since it would block the device again.
    pub(in crate::app) fn cut_short(&mut self, generation: u64) {
        if let Some(version) = self.of_generation_mut(generation) {
            version.is_cut_short = true;
        }
    }

    /// Marks a version as good again: a setting had made its loop endless.
    pub(in crate::app) fn loops_end(&mut self, generation: u64) {
        if let Some(version) = self.of_generation_mut(generation) {
            version.is_cut_short = false;
        }
    }

    /// Whether a version is the one of these shaders.
    pub(in crate::app) fn has(&self, shaders: &Arc<ShaderSet>) -> bool {
        self.list.iter().any(|version| Arc::ptr_eq(&version.shaders, shaders))
    }

    /// Notes shaders that show an older version again, so that they make no version.
    pub(in crate::app) fn shows_again(&mut self, shaders: &Arc<ShaderSet>) {
        self.again = Some(shaders.clone());
    }

    /// Whether these shaders make a version.
    pub(in crate::app) fn is_new(&self, shaders: &Arc<ShaderSet>) -> bool {
        let is_again = |again: &Arc<ShaderSet>| again.generation == shaders.generation && again.texts == shaders.texts;
        shaders.tree == self.tree && !self.has(shaders) && !self.again.as_ref().is_some_and(is_again)
    }

    /// Versions that lack a thumbnail, the newest first.
    pub(in crate::app) fn without_thumbnail(&self) -> impl Iterator<Item = &Version> {
        self.list.iter().rev().filter(|version| version.thumbnail.is_none() && !version.is_cut_short)
    }

    /// Whether a version can be shown beside the generation `newest`, which is on screen.
    pub(in crate::app) fn can_show(&self, version: &Version, newest: u64) -> bool {
        version.generation < newest && !version.is_cut_short
    }

    /// The newest version before the generation `newest`.
    pub(in crate::app) fn last_before(&self, newest: u64) -> Option<&Version> {
        self.list.iter().rev().find(|version| version.generation < newest)
    }

    /// The newest version before `newest` that can be shown.
    pub(in crate::app) fn before(&self, newest: u64) -> Option<&Version> {
        self.list.iter().rev().find(|version| self.can_show(version, newest))
    }

    /// The version that a version was made from, and the lines in which their texts differ.
    pub(in crate::app) fn difference<'a>(&'a self, version: &'a Version) -> &'a [Line] {
        let before = self.last_before(version.generation);
        version.difference.get_or_init(|| {
            before.map(|before| difference(&before.shaders.texts, &version.shaders.texts)).unwrap_or_default()
        })
    }

    /// Drops all versions but the newest, while memory is short.
    pub(in crate::app) fn drop_old(&mut self) {
        self.aside.clear();
        self.list.drain(..self.list.len().saturating_sub(1));
    }
}

/// Whether the files of both have the same texts. While stages are still to be compiled, shaders lack files that only these have.
fn has_same_texts(a: &ShaderSet, b: &ShaderSet) -> bool {
    let (few, all) = if a.texts.len() < b.texts.len() { (a, b) } else { (b, a) };
    let is_same = few.texts.iter().all(|(path, text)| all.texts.get(path) == Some(text));
    is_same && (few.texts.len() == all.texts.len() || !few.is_complete())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::shader::TreePath;

    fn shaders(generation: u64, text: &str) -> Arc<ShaderSet> {
        let texts = BTreeMap::from([(TreePath::from("a.glsl"), Arc::<str>::from(text))]);
        Arc::new(ShaderSet { generation, texts, ..ShaderSet::default() })
    }

    fn save() -> ReloadEvent {
        ReloadEvent { changed: vec!["brdf/a.glsl".to_owned()], ..ReloadEvent::default() }
    }

    fn numbers(versions: &Versions) -> Vec<u64> {
        versions.iter().map(|version| version.number).collect()
    }

    #[test]
    fn the_newest_versions_are_kept() {
        let mut versions = Versions::default();
        (1..=15).for_each(|number| versions.add(&shaders(number, &number.to_string()), save(), false));
        assert_eq!(numbers(&versions), (4..=15).collect::<Vec<_>>());
        versions.drop_old();
        assert_eq!(numbers(&versions), [15]);
    }

    #[test]
    fn a_tree_has_its_versions_when_it_is_opened_again() {
        let of =
            |tree, generation, text: &str| Arc::new(ShaderSet { tree, ..ShaderSet::clone(&shaders(generation, text)) });
        let [a, b] = [Path::new("/a"), Path::new("/b")];
        let mut versions = Versions::default();
        (1..=2).for_each(|number| versions.add(&of(0, number, &number.to_string()), save(), false));
        assert_eq!(versions.change_tree(Some(a), Some(b)), 1);
        assert!(numbers(&versions).is_empty());
        // The tree before is still on screen.
        assert!(!versions.is_new(&of(0, 2, "2")) && versions.is_new(&of(1, 3, "other")));
        versions.add(&of(1, 3, "other"), save(), false);
        assert_eq!(numbers(&versions), [1]);
        assert!(versions.keeps(2) && versions.keeps(3) && !versions.keeps(4));
        assert_eq!(versions.change_tree(Some(b), Some(a)), 0);
        // Nothing was edited meanwhile, so the newest version is on screen again.
        versions.add(&of(0, 4, "2"), save(), false);
        assert_eq!(numbers(&versions), [1, 2]);
        assert!(versions.of_generation(4).is_some() && versions.before(4).is_some_and(|version| version.number == 1));
        // The first shaders of a tree lack files of stages that are compiled later.
        let mut whole = ShaderSet::clone(&of(0, 4, "2"));
        whole.texts.insert(TreePath::from("b.glsl"), "b".into());
        versions.complete(&Arc::new(whole));
        let pending = std::collections::BTreeSet::from(["b.frag".to_owned()]);
        versions.add(&Arc::new(ShaderSet { pending, ..ShaderSet::clone(&of(0, 5, "2")) }), save(), false);
        assert_eq!(numbers(&versions), [1, 2]);
        // The same tree from scratch.
        assert_eq!(versions.change_tree(Some(a), Some(a)), 0);
        assert_eq!(numbers(&versions), [1, 2]);
        // A tree that is not on disk is another one each time.
        for number in 2..8 {
            assert_eq!(versions.change_tree(None, None), number);
        }
        versions.drop_old();
        assert_eq!(versions.change_tree(None, Some(a)), 8);
        assert!(!versions.keeps(1));
    }

    #[test]
    fn dragged_numbers_make_one_version() {
        let mut versions = Versions::default();
        versions.add(&shaders(1, "a"), save(), false);
        versions.add(&shaders(2, "b"), save(), true);
        versions.add(&shaders(3, "c"), save(), true);
        assert_eq!(numbers(&versions), [1, 2], "no number is left out");
        // The texts of the files are back, so it is the version before.
        versions.add(&shaders(4, "a"), save(), false);
        assert_eq!(numbers(&versions), [1]);
        versions.add(&shaders(5, "d"), save(), true);
        versions.keep_draft();
        versions.add(&shaders(6, "e"), save(), false);
        assert_eq!(numbers(&versions), [1, 2, 3]);
    }

    #[test]
    fn a_version_whose_loop_did_not_end_is_passed_over() {
        let mut versions = Versions::default();
        (1..=3).for_each(|number| versions.add(&shaders(number, &number.to_string()), save(), false));
        versions.cut_short(2);
        assert_eq!(versions.before(3).map(|version| version.number), Some(1));
        assert_eq!(versions.last_before(3).map(|version| version.number), Some(2));
        assert_eq!(versions.without_thumbnail().map(|version| version.number).collect::<Vec<_>>(), [3, 1]);
        versions.loops_end(2);
        assert_eq!(versions.before(3).map(|version| version.number), Some(2));
    }

    #[test]
    fn a_version_keeps_its_number_when_it_comes_back() {
        let mut versions = Versions::default();
        versions.add(&shaders(1, "a"), ReloadEvent::default(), false);
        versions.add(&shaders(2, "b"), save(), false);
        // Generation 3 showed version 1 again, which is no version of its own.
        versions.add(&shaders(4, "b"), save(), false);
        assert_eq!(numbers(&versions), [1, 2]);
        assert_eq!(versions.of_generation(4).map(|version| version.number), Some(2));
        assert_eq!(versions.before(4).map(|version| version.number), Some(1));
        let titles: Vec<String> = versions.iter().map(Version::title).collect();
        assert_eq!(titles, ["whole tree", "a.glsl"]);
        assert!(versions.difference(versions.get(2).unwrap()).iter().any(|line| line.text.contains('b')));
    }
}
