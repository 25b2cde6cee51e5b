//! The rows of the tree: nodes with their primitives, materials, textures, cameras and lights.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use crate::app::state::selection::{LightId, Selected, name_or};
use crate::app::widgets::plural;
use crate::app::widgets::search::Words;
use crate::frame::Scene;
use crate::scene::{Instance, LightKind, Model, TextureSource};

/// A list of parts of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Group {
    Nodes,
    Materials,
    Textures,
    Cameras,
    Lights,
}

/// A row of the tree.
#[derive(Clone, Debug)]
pub(super) struct TreeRow {
    pub(super) depth: usize,
    pub(super) name: String,
    /// Counts and sizes, at the right.
    pub(super) detail: String,
    /// Item that the row selects; `None` for the title of a group.
    pub(super) item: Option<Selected>,
    group: Group,
    /// Whether rows below it can be folded away; `Some(true)` if they are.
    pub(super) is_folded: Option<bool>,
    /// The name by which settings hide it.
    pub(super) key: Option<String>,
}

/// The rows that are shown, and which are folded.
#[derive(Default)]
pub(super) struct Tree {
    folded: HashSet<(Group, Option<Selected>)>,
    /// All rows of the model, of which a large one has many.
    all: Vec<TreeRow>,
    /// Those that are shown, as indices.
    shown: Vec<usize>,
    /// The scene of the last frame, and whether each of its nodes, or something below it, is drawn.
    drawn: Option<(Scene, Vec<bool>)>,
    /// Whether folding has changed since the shown rows were chosen.
    is_changed: bool,
    /// Inputs of the shown rows: the model and the search text.
    made_of: Option<(Arc<Model>, String)>,
    /// The part that stands for each instance of the model.
    parts: Option<(Arc<Model>, Vec<Selected>)>,
}

impl Tree {
    /// The rows that are shown.
    pub(super) fn rows(&self) -> impl ExactSizeIterator<Item = &TreeRow> {
        self.shown.iter().map(|index| &self.all[*index])
    }

    /// A row that is shown.
    pub(super) fn row(&self, at: usize) -> Option<&TreeRow> {
        self.shown.get(at).map(|index| &self.all[*index])
    }

    /// Whether a part is drawn, or something below it.
    pub(super) fn is_drawn(&self, item: Selected) -> bool {
        let Some((scene, nodes)) = &self.drawn else { return true };
        match item {
            Selected::Node(node) => nodes.get(node) != Some(&false),
            Selected::Instance(instance) => scene.is_visible(instance),
            _ => true,
        }
    }

    /// Makes the rows again if the model or the search differs.
    pub(super) fn update(&mut self, scene: &Scene, search: &str) {
        if self.drawn.as_ref().is_none_or(|(before, _)| !before.has_same_draws(scene)) {
            self.drawn = Some((scene.clone(), drawn_nodes(scene)));
        }
        let model = scene.loaded();
        self.know(model);
        let is_same = |(made, text): &(Arc<Model>, String)| Arc::ptr_eq(made, model) && text == search;
        if !std::mem::take(&mut self.is_changed) && self.made_of.as_ref().is_some_and(is_same) {
            return;
        }
        if self.made_of.as_ref().is_none_or(|(made, _)| !Arc::ptr_eq(made, model)) {
            self.folded.clear();
            self.all = rows(model);
        }
        let words = Words::new(search);
        match words.is_empty() {
            true => self.unfold(),
            false => {
                let has = |index: &usize| self.all[*index].item.is_some() && words.are_in(&self.all[*index].name);
                self.shown = (0..self.all.len()).filter(has).collect();
            }
        }
        self.made_of = Some((model.clone(), search.to_owned()));
    }

    /// Shows all but what is below folded rows.
    fn unfold(&mut self) {
        let mut below = None;
        self.shown.clear();
        for (index, row) in self.all.iter_mut().enumerate() {
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
        self.know(scene.loaded());
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

    /// Finds the part that stands for each instance, unless it is known.
    fn know(&mut self, model: &Arc<Model>) {
        if self.parts.as_ref().is_none_or(|(of, _)| !Arc::ptr_eq(of, model)) {
            self.parts = Some((model.clone(), parts(model)));
        }
    }

    /// The part whose row stands for a selection.
    pub(super) fn part_of(&self, selected: Selected) -> Option<Selected> {
        match selected {
            Selected::Nothing => None,
            Selected::Instance(index) => self.parts.as_ref().and_then(|(_, parts)| parts.get(index)).copied(),
            other => Some(other),
        }
    }

    /// The index of the row of a selection.
    pub(super) fn place(&self, selected: Selected) -> Option<usize> {
        let part = self.part_of(selected)?;
        self.rows().position(|row| row.item == Some(part))
    }
}

/// The place of each node in the model, by its index in the file.
struct NodePlaces(Vec<Option<usize>>);

impl NodePlaces {
    fn new(model: &Model) -> Self {
        let mut places = vec![None; model.nodes.iter().map(|node| node.index + 1).max().unwrap_or(0)];
        model.nodes.iter().enumerate().for_each(|(at, node)| places[node.index] = Some(at));
        Self(places)
    }

    /// The place of the node of an instance.
    fn of(&self, instance: &Instance) -> Option<usize> {
        self.0.get(instance.node).copied().flatten()
    }
}

/// The part that stands for each instance: a primitive that is alone in its node has no row of its own.
fn parts(model: &Model) -> Vec<Selected> {
    let (places, mut counts) = (NodePlaces::new(model), vec![0; model.nodes.len()]);
    model.instances.iter().filter_map(|instance| places.of(instance)).for_each(|node| counts[node] += 1);
    let part = |(index, instance): (usize, &Instance)| match places.of(instance) {
        Some(node) if counts[node] == 1 => Selected::Node(node),
        _ => Selected::Instance(index),
    };
    model.instances.iter().enumerate().map(part).collect()
}

/// Whether each node, or something below it, is drawn; true for nodes with nothing to draw.
fn drawn_nodes(scene: &Scene) -> Vec<bool> {
    let model = scene.model();
    let places = NodePlaces::new(model);
    // Whether there is something to draw, and whether it is drawn.
    let mut nodes = vec![(false, false); model.nodes.len()];
    for (index, instance) in model.instances.iter().enumerate() {
        if let Some(at) = places.of(instance) {
            nodes[at].0 = true;
            nodes[at].1 |= scene.is_visible(index);
        }
    }
    // Children come after their parents.
    for (at, node) in model.nodes.iter().enumerate().rev() {
        if let Some(parent) = node.parent {
            let (has, is) = nodes[at];
            nodes[parent].0 |= has;
            nodes[parent].1 |= is;
        }
    }
    nodes.into_iter().map(|(has, is)| is || !has).collect()
}

/// All rows of a model.
fn rows(model: &Model) -> Vec<TreeRow> {
    let (mut rows, material_keys) = (Vec::new(), model.material_keys());
    nodes(model, &material_keys, &mut rows);
    let mut uses = vec![0; model.materials.len()];
    for primitive in model.primitives.iter() {
        uses.get_mut(primitive.default_material).into_iter().for_each(|uses: &mut usize| *uses += 1);
    }
    let materials = uses
        .iter()
        .enumerate()
        .skip(1)
        .map(|(index, used)| (material_keys[index].clone(), plural(*used, "primitive"), Selected::Material(index)));
    group(&mut rows, Group::Materials, "Materials", materials.collect());
    let textures = textures(model).into_keys().map(|source| {
        let image = source.image(model);
        let (name, size) = image
            .map_or_else(Default::default, |image| (image.name.clone(), format!("{} × {}", image.width, image.height)));
        let size = if model.awaits_textures { "decoding".to_owned() } else { size };
        (name_or(&name, || "texture".to_owned()), size, Selected::Texture(source))
    });
    group(&mut rows, Group::Textures, "Textures", textures.collect());
    let cameras = model.cameras.iter().enumerate().map(|(index, camera)| {
        let name = name_or(&camera.name, || format!("camera {index}"));
        (name, camera.lens.to_string(), Selected::Camera(index))
    });
    group(&mut rows, Group::Cameras, "Cameras", cameras.collect());
    let mut lights: Vec<(String, String, Selected)> = (0..3)
        .map(|light| (format!("Light {}", light + 1), "orbit".to_owned(), Selected::Light(LightId::Orbit(light))))
        .collect();
    lights.push(("Rectangle".to_owned(), "area".to_owned(), Selected::Light(LightId::Rectangle)));
    lights.extend(model.lights.iter().enumerate().map(|(index, light)| {
        let name = name_or(&light.name, || format!("light {index} of the file"));
        (name, kind(light.kind).to_owned(), Selected::Light(LightId::Model(index)))
    }));
    group(&mut rows, Group::Lights, "Lights", lights);
    rows
}

/// The name of a kind of light.
pub(super) fn kind(kind: LightKind) -> &'static str {
    match kind {
        LightKind::Directional => "directional",
        LightKind::Point => "point",
        LightKind::Spot { .. } => "spot",
    }
}

/// The title of a group, and its rows.
fn group(rows: &mut Vec<TreeRow>, group: Group, title: &str, items: Vec<(String, String, Selected)>) {
    if items.is_empty() {
        return;
    }
    rows.push(title_of(group, title, items.len()));
    rows.extend(items.into_iter().map(|(name, detail, item)| TreeRow {
        depth: 1,
        name,
        detail,
        item: Some(item),
        group,
        is_folded: None,
        key: None,
    }));
}

fn title_of(group: Group, title: &str, count: usize) -> TreeRow {
    let (name, detail) = (title.to_owned(), count.to_string());
    TreeRow { depth: 0, name, detail, item: None, group, is_folded: Some(false), key: None }
}

/// The nodes, each with the primitives of its mesh if there are several.
fn nodes(model: &Model, material_keys: &[String], rows: &mut Vec<TreeRow>) {
    let node_of = |instance: &usize| model.instances[*instance].node;
    let mut by_node: Vec<usize> = (0..model.instances.len()).collect();
    by_node.sort_by_key(node_of);
    let (group, keys) = (Group::Nodes, model.node_keys());
    rows.push(title_of(group, "Nodes", model.nodes.len()));
    let mut depths = Vec::with_capacity(model.nodes.len());
    for (at, node) in model.nodes.iter().enumerate() {
        let depth = node.parent.map_or(1, |parent| depths[parent] + 1);
        depths.push(depth);
        let first = by_node.partition_point(|instance| node_of(instance) < node.index);
        let instances = by_node[first..].chunk_by(|a, b| node_of(a) == node_of(b)).next().unwrap_or_default();
        let instances = if instances.first().map(node_of) == Some(node.index) { instances } else { &[] };
        let triangles = |instance: &usize| model.primitives[model.instances[*instance].primitive].indices.len() / 3;
        let total: usize = instances.iter().map(triangles).sum();
        let has_children = model.nodes.get(at + 1).is_some_and(|next| next.parent == Some(at));
        let detail = match (instances, node.camera, node.light) {
            ([], Some(_), _) => "camera".to_owned(),
            ([], _, Some(_)) => "light".to_owned(),
            ([], ..) => String::new(),
            _ => thousands(total),
        };
        let item = Some(Selected::Node(at));
        let name = name_or(&node.name, || {
            node.mesh.clone().filter(|mesh| !mesh.is_empty()).unwrap_or_else(|| format!("node {}", node.index))
        });
        let is_folded = (has_children || instances.len() > 1).then_some(false);
        rows.push(TreeRow { depth, name, detail, item, group, is_folded, key: keys.get(at).cloned() });
        for instance in instances.iter().filter(|_| instances.len() > 1) {
            let primitive = &model.primitives[model.instances[*instance].primitive];
            rows.push(TreeRow {
                depth: depth + 1,
                name: format!("{} · {}", primitive.name, material_keys[primitive.default_material]),
                detail: thousands(triangles(instance)),
                item: Some(Selected::Instance(*instance)),
                group,
                is_folded: None,
                key: Some(primitive.name.clone()),
            });
        }
    }
}

/// A count with its unit, short: `12.3k tris`.
fn thousands(triangles: usize) -> String {
    match triangles {
        0..1000 => format!("{triangles} tris"),
        1000..1_000_000 => format!("{:.1}k tris", triangles as f64 / 1e3),
        _ => format!("{:.1}M tris", triangles as f64 / 1e6),
    }
}

/// The textures of the materials, each with the materials and slots that read it.
pub(in crate::app) fn textures(model: &Model) -> BTreeMap<TextureSource, Vec<(usize, usize)>> {
    let mut textures: BTreeMap<TextureSource, Vec<(usize, usize)>> = BTreeMap::new();
    for (index, material) in model.materials.iter().enumerate() {
        for slot in (0..material.textures.len()).filter(|slot| material.textures[*slot].is_some()) {
            textures.entry(TextureSource::of(model, material, slot)).or_default().push((index, slot));
        }
    }
    textures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{BUILT_IN, built_in};
    use crate::settings::Settings;

    fn scene(name: &str) -> Scene {
        Scene::new(&Arc::new(built_in(name).unwrap().unwrap()), &Settings::default())
    }

    #[test]
    fn the_tree_lists_every_part_and_a_search_finds_it() {
        for name in BUILT_IN {
            let (scene, mut tree) = (scene(name), Tree::default());
            let model = scene.model();
            tree.update(&scene, "");
            let has = |tree: &Tree, item| tree.rows().any(|row| row.item == Some(item));
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
            assert!(tree.rows().len() == 0);
        }
    }

    #[test]
    fn folded_rows_unfold_for_a_selection() {
        let (scene, mut tree) = (scene(BUILT_IN[0]), Tree::default());
        tree.update(&scene, "");
        let all = tree.rows().len();
        tree.toggle(0);
        tree.update(&scene, "");
        assert!(tree.rows().len() < all && tree.place(Selected::Instance(0)).is_none());
        tree.reveal(&scene, Selected::Instance(0));
        tree.update(&scene, "");
        assert!(tree.place(Selected::Instance(0)).is_some());
    }
}
