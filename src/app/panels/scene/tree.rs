//! The tree: which rows of the model are shown, and which of them are drawn.

use std::collections::HashSet;
use std::sync::Arc;

use super::rows::{Group, Listing, TreeRow};
use crate::app::state::selection::{LightId, Selected};
use crate::app::widgets::search::Words;
use crate::frame::Scene;
use crate::scene::Model;
use crate::threads::later::Later;

/// Most nodes, instances and materials of a model whose rows are made within a frame: a row takes some microseconds.
const AT_ONCE: usize = 500;

/// The rows that a thread makes, or why it could not.
type Coming = Result<Later<Listing>, String>;

/// The rows that are shown, and which are folded.
#[derive(Default)]
pub(super) struct Tree {
    folded: HashSet<(Group, Option<Selected>)>,
    /// All rows, of this model or of one that shares its parts.
    listing: Option<Listing>,
    /// The model whose rows a thread makes.
    coming: Option<(Arc<Model>, Coming)>,
    /// The rows that are shown, as indices.
    shown: Vec<usize>,
    drawn: Option<Drawn>,
    /// Whether folding has changed since the shown rows were chosen.
    is_changed: bool,
    /// Inputs of the shown rows: the model and the search text.
    made_of: Option<(Arc<Model>, String)>,
}

/// Whether the rows of a model are there.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Listed {
    Ready,
    /// A thread makes them.
    Coming,
    Failed(String),
}

/// The nodes of the last frame's scene that are drawn.
struct Drawn {
    scene: Scene,
    /// Whether the settings let each node, or something below it, be drawn.
    wanted: Vec<bool>,
    /// Whether it is drawn: the file and its clips hide nodes, too.
    visible: Vec<bool>,
}

impl Drawn {
    fn new(scene: &Scene, listing: &Listing) -> Self {
        let of = |is: fn(&Scene, usize) -> bool| listing.drawn_nodes(|instance| is(scene, instance));
        Self { scene: scene.clone(), wanted: of(Scene::is_wanted), visible: of(Scene::is_visible) }
    }

    fn is_of(&self, scene: &Scene) -> bool {
        self.scene.has_same_draws(scene) && self.scene.pose().hidden == scene.pose().hidden
    }
}

impl Tree {
    /// The number of rows that are shown.
    pub(super) fn len(&self) -> usize {
        self.shown.len()
    }

    /// A row that is shown.
    pub(super) fn row(&self, at: usize) -> Option<&TreeRow> {
        self.listing.as_ref()?.rows.get(*self.shown.get(at)?)
    }

    /// Whether the rows of a model are there. If not, a thread makes those of a large model, so that no frame waits for them.
    pub(super) fn list(&mut self, model: &Arc<Model>) -> Listed {
        if self.listing.as_ref().is_some_and(|listing| Arc::ptr_eq(&listing.model, model)) {
            return Listed::Ready;
        }
        if model.nodes.len() + model.instances.len() + model.materials.len() <= AT_ONCE {
            self.take(Listing::new(model));
            return Listed::Ready;
        }
        if self.coming.as_ref().is_none_or(|(of, _)| !Arc::ptr_eq(of, model)) {
            let of = model.clone();
            self.coming = Some((model.clone(), Ok(Later::start("specula-rows", move || Listing::new(&of)))));
        }
        let result = match &self.coming {
            Some((_, Ok(later))) => later.get(),
            Some((_, Err(why))) => Some(Err(why.clone())),
            None => None,
        };
        match result {
            Some(Ok(listing)) => self.take(listing),
            Some(Err(why)) => {
                self.coming = Some((model.clone(), Err(why.clone())));
                return Listed::Failed(why);
            }
            // The same model without its textures: its rows stay until then.
            None if self.listing.as_ref().is_some_and(|listing| listing.is_of_parts_of(model)) => {}
            None => return Listed::Coming,
        }
        Listed::Ready
    }

    /// Shows other rows from now on.
    fn take(&mut self, listing: Listing) {
        self.coming = None;
        if let Some(before) = self.listing.replace(listing) {
            if self.listing.as_ref().is_some_and(|now| !now.is_of_parts_of(&before.model)) {
                self.folded.clear();
            }
            // To free a large model takes longer than a frame.
            rayon::spawn(move || drop(before));
        }
        (self.made_of, self.drawn) = (None, None);
        self.shown.clear();
    }

    /// Whether the settings let a part be drawn, or something below it.
    pub(super) fn is_wanted(&self, item: Selected) -> bool {
        self.drawn.as_ref().is_none_or(|drawn| match item {
            Selected::Node(node) => drawn.wanted.get(node) != Some(&false),
            Selected::Instance(instance) => drawn.scene.is_wanted(instance),
            _ => true,
        })
    }

    /// Whether a part is drawn, or something below it.
    pub(super) fn is_visible(&self, item: Selected) -> bool {
        self.drawn.as_ref().is_none_or(|drawn| match item {
            Selected::Node(node) => drawn.visible.get(node) != Some(&false),
            Selected::Instance(instance) => drawn.scene.is_visible(instance),
            Selected::Light(LightId::Model(light)) => !drawn.scene.pose().hidden.light(light),
            _ => true,
        })
    }

    /// Chooses the rows that are shown again, if the scene or the search differs. Does nothing before they are listed.
    pub(super) fn update(&mut self, scene: &Scene, search: &str) {
        let Some(listing) = &self.listing else { return };
        if self.drawn.as_ref().is_none_or(|drawn| !drawn.is_of(scene)) {
            self.drawn = Some(Drawn::new(scene, listing));
        }
        let model = scene.loaded();
        let is_same = |(made, text): &(Arc<Model>, String)| Arc::ptr_eq(made, model) && text == search;
        if !std::mem::take(&mut self.is_changed) && self.made_of.as_ref().is_some_and(is_same) {
            return;
        }
        let words = Words::new(search);
        match words.is_empty() {
            true => self.unfold(),
            false => {
                let has = |row: &TreeRow| row.item.is_some() && words.are_in(&row.name);
                self.shown = (0..).zip(&listing.rows).filter(|(_, row)| has(row)).map(|(index, _)| index).collect();
            }
        }
        self.made_of = Some((model.clone(), search.to_owned()));
    }

    /// Shows all but what is below folded rows.
    fn unfold(&mut self) {
        let mut below = None;
        self.shown.clear();
        for (index, row) in self.listing.iter_mut().flat_map(|listing| &mut listing.rows).enumerate() {
            if below.is_some_and(|depth| row.depth > depth) {
                continue;
            }
            let is_folded = row.is_folded.is_some() && self.folded.contains(&(row.group, row.item));
            below = is_folded.then_some(row.depth);
            row.is_folded = row.is_folded.map(|_| is_folded);
            self.shown.push(index);
        }
    }

    /// Folds or unfolds the rows below a row.
    pub(super) fn toggle(&mut self, at: usize) {
        let Some(row) = self.row(at) else { return };
        let key = (row.group, row.item);
        if !self.folded.remove(&key) {
            self.folded.insert(key);
        }
        self.is_changed = true;
    }

    /// Unfolds what hides a selection.
    pub(super) fn reveal(&mut self, scene: &Scene, selected: Selected) {
        let Some(part) = self.part_of(selected) else { return };
        let mut node = match part {
            Selected::Node(node) => Some(node),
            Selected::Instance(instance) => scene.model().node_of(&scene.model().instances[instance]),
            _ => None,
        };
        let before = self.folded.len();
        self.folded.retain(|(_, item)| item.is_some());
        while let Some(at) = node {
            self.folded.remove(&(Group::Nodes, Some(Selected::Node(at))));
            node = scene.model().nodes[at].parent;
        }
        self.is_changed |= self.folded.len() != before;
    }

    /// The part whose row stands for a selection.
    pub(super) fn part_of(&self, selected: Selected) -> Option<Selected> {
        match selected {
            Selected::Nothing => None,
            Selected::Instance(index) => self.listing.as_ref().and_then(|listing| listing.parts.get(index)).copied(),
            other => Some(other),
        }
    }

    /// The index of the row of a selection.
    pub(super) fn place(&self, selected: Selected) -> Option<usize> {
        let part = self.part_of(selected)?;
        (0..self.len()).find(|at| self.row(*at).is_some_and(|row| row.item == Some(part)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{BUILT_IN, Node, built_in};
    use crate::settings::Settings;

    fn scene(name: &str) -> Scene {
        Scene::new(&Arc::new(built_in(name).unwrap().unwrap()), &Settings::default())
    }

    fn rows(tree: &Tree) -> impl Iterator<Item = &TreeRow> {
        (0..tree.len()).filter_map(|at| tree.row(at))
    }

    #[test]
    fn the_tree_lists_every_part_and_a_search_finds_it() {
        for name in BUILT_IN {
            let (scene, mut tree) = (scene(name), Tree::default());
            let model = scene.model();
            assert_eq!(tree.list(model), Listed::Ready);
            tree.update(&scene, "");
            let has = |tree: &Tree, item| rows(tree).any(|row| row.item == Some(item));
            assert!((0..model.nodes.len()).all(|node| has(&tree, Selected::Node(node))), "{name}");
            assert!((1..model.materials.len()).all(|material| has(&tree, Selected::Material(material))), "{name}");
            assert!((0..model.lights.len()).all(|light| has(&tree, Selected::Light(LightId::Model(light)))), "{name}");
            for instance in 0..model.instances.len() {
                assert!(tree.place(Selected::Instance(instance)).is_some(), "{name}: {instance}");
            }
            let material = model.material_key(1);
            tree.update(&scene, &material.to_uppercase());
            assert!(has(&tree, Selected::Material(1)), "{name}: {material}");
            tree.update(&scene, "no part has this name");
            assert_eq!(tree.len(), 0);
        }
    }

    #[test]
    fn folded_rows_unfold_for_a_selection() {
        let (scene, mut tree) = (scene(BUILT_IN[0]), Tree::default());
        assert_eq!(tree.list(scene.model()), Listed::Ready);
        tree.update(&scene, "");
        let all = tree.len();
        tree.toggle(0);
        tree.update(&scene, "");
        assert!(tree.len() < all && tree.place(Selected::Instance(0)).is_none());
        tree.reveal(&scene, Selected::Instance(0));
        tree.update(&scene, "");
        assert!(tree.place(Selected::Instance(0)).is_some());
    }

    /// A model with many nodes above the parts of a small one, whose rows a thread makes.
    fn large(nodes: usize) -> Model {
        let mut model = built_in(BUILT_IN[0]).unwrap().unwrap();
        let first = model.nodes.iter().map(|node| node.index + 1).max().unwrap();
        let node = |index: usize| Node { index: first + index, name: format!("node {index}"), ..Node::default() };
        model.nodes = model.nodes.iter().cloned().chain((0..nodes).map(node)).collect::<Vec<_>>().into();
        model
    }

    #[test]
    fn a_thread_lists_a_large_model() {
        let model = Arc::new(large(20_000));
        let (scene, mut tree) = (Scene::new(&model, &Settings::default()), Tree::default());
        let wait = |tree: &mut Tree, model: &Arc<Model>| {
            while tree.list(model) == Listed::Coming {
                std::thread::yield_now();
            }
            assert_eq!(tree.list(model), Listed::Ready);
        };
        assert_eq!(tree.list(&model), Listed::Coming, "the frame made the rows itself");
        tree.update(&scene, "");
        assert_eq!((tree.len(), tree.place(Selected::Node(0))), (0, None));
        wait(&mut tree, &model);
        tree.update(&scene, "");
        let items: HashSet<Selected> = rows(&tree).filter_map(|row| row.item).collect();
        assert!((0..model.nodes.len()).all(|node| items.contains(&Selected::Node(node))));
        // The same parts with other textures keep their rows, and what is folded, until theirs are there.
        tree.toggle(0);
        tree.update(&scene, "");
        let folded = tree.len();
        let whole = Arc::new(Model { awaits_textures: true, ..(*model).clone() });
        let scene = Scene::new(&whole, &Settings::default());
        assert_eq!(tree.list(&whole), Listed::Ready);
        tree.update(&scene, "");
        assert_eq!(tree.len(), folded);
        while tree.coming.is_some() {
            assert_eq!(tree.list(&whole), Listed::Ready);
        }
        tree.update(&scene, "");
        assert_eq!(tree.len(), folded);
        // Another model's rows replace them.
        let other = Arc::new(large(10_000));
        assert_eq!(tree.list(&other), Listed::Coming);
        wait(&mut tree, &other);
        tree.update(&Scene::new(&other, &Settings::default()), "");
        assert!(tree.len() > 10_000 && tree.len() < 20_000);
    }
}
