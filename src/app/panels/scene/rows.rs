//! The parts of a model as rows: nodes with their primitives, materials, textures, cameras and lights.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::app::state::selection::{LightId, Selected, name_or};
use crate::app::widgets::plural;
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
    pub(super) group: Group,
    /// Whether rows below it can be folded away; `Some(true)` if they are.
    pub(super) is_folded: Option<bool>,
    /// The name by which settings hide it.
    pub(super) key: Option<String>,
}

/// All rows of a model. Of a large one, making them takes longer than a frame.
pub(super) struct Listing {
    pub(super) model: Arc<Model>,
    pub(super) rows: Vec<TreeRow>,
    /// The part that stands for each instance.
    pub(super) parts: Vec<Selected>,
    places: NodePlaces,
}

impl Listing {
    pub(super) fn new(model: &Arc<Model>) -> Self {
        let places = NodePlaces::new(model);
        Self { model: model.clone(), rows: rows(model), parts: parts(model, &places), places }
    }

    /// Whether its rows are also those of another model, but for the textures.
    pub(super) fn is_of_parts_of(&self, model: &Model) -> bool {
        Arc::ptr_eq(&self.model.nodes, &model.nodes) && Arc::ptr_eq(&self.model.primitives, &model.primitives)
    }

    /// Whether each node, or something below it, is drawn, if that is said of each instance; true for nodes with nothing to draw.
    pub(super) fn drawn_nodes(&self, is_drawn: impl Fn(usize) -> bool) -> Vec<bool> {
        let model = &self.model;
        // Whether there is something to draw, and whether it is drawn.
        let mut nodes = vec![(false, false); model.nodes.len()];
        for (index, instance) in model.instances.iter().enumerate() {
            if let Some(at) = self.places.of(instance) {
                nodes[at].0 = true;
                nodes[at].1 |= is_drawn(index);
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
fn parts(model: &Model, places: &NodePlaces) -> Vec<Selected> {
    let mut counts = vec![0; model.nodes.len()];
    model.instances.iter().filter_map(|instance| places.of(instance)).for_each(|node| counts[node] += 1);
    let part = |(index, instance): (usize, &Instance)| match places.of(instance) {
        Some(node) if counts[node] == 1 => Selected::Node(node),
        _ => Selected::Instance(index),
    };
    model.instances.iter().enumerate().map(part).collect()
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
            _ if node.is_hidden => "hidden in the file".to_owned(),
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
        // The settings cannot show it.
        let key = keys.get(at).filter(|_| !node.is_hidden).cloned();
        rows.push(TreeRow { depth, name, detail, item, group, is_folded, key });
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
