//! Parts of a file that cannot be used. The model is shown without them, and a warning says why.

use std::collections::HashMap;

use crate::scene::error::{EXPORT_AGAIN, Problem};

/// Maximum number of places that a warning names.
const MOST_NAMED: usize = 3;
/// Maximum number of warnings.
const MOST_TOLD: usize = 50;

/// A kind of part. A warning says: "the `noun` is `fate`."
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Part {
    noun: &'static str,
    fate: &'static str,
    /// The remedy, unless the problem says it.
    remedy: &'static str,
}

impl Part {
    /// The mesh of a node.
    pub const MESH: Self = Self::new("mesh", "left out");
    /// A primitive of a mesh.
    pub const PRIMITIVE: Self = Self::new("primitive", "left out");
    /// A skin, or the joints of a primitive.
    pub const SKIN: Self = Self::new("skin", "left out: the mesh stands where its node is");
    /// A morph target.
    pub const TARGET: Self = Self::new("morph target", "left out: its weight changes nothing");
    /// A channel of an animation.
    pub const CHANNEL: Self = Self { remedy: "", ..Self::new("channel", "not played") };
    /// A camera.
    pub const CAMERA: Self = Self::new("camera", "left out");
    /// A punctual light.
    pub const LIGHT: Self = Self::new("light", "left out");
    /// The instances of a node.
    pub const INSTANCES: Self = Self::new("extension", "left out: the mesh is shown once");
    /// The variants of a file.
    pub const VARIANTS: Self = Self::new("extension", "left out: the model has no variants");
    /// The materials of a primitive in the variants.
    pub const MAPPING: Self = Self::new("mapping", "left out: the primitive keeps its material in all variants");
    /// The material of a primitive.
    pub const MATERIAL: Self = Self::new("material", "replaced by the default material");
    /// An extension of a material.
    pub const EXTENSION: Self = Self::new("extension", "left out");
    /// A number that has a default.
    pub const NUMBER: Self = Self::new("number", "replaced by its default");
    /// The alpha mode of a material.
    pub const ALPHA_MODE: Self = Self::new("alpha mode", "replaced by OPAQUE");
    /// A texture of a material.
    pub const TEXTURE: Self = Self::new("texture", "left out");
    /// The sampler of a texture.
    pub const SAMPLER: Self = Self::new("sampler", "replaced by the default sampler");
    /// A compressed stream beside uncompressed data.
    pub const STREAM: Self = Self::new("stream", "left out: the uncompressed data is used");
    /// The part that a buffer lacks at its end.
    pub const END: Self = Self::new("buffer", "used as far as it goes");

    const fn new(noun: &'static str, fate: &'static str) -> Self {
        Self { noun, fate, remedy: EXPORT_AGAIN }
    }

    /// Whether the part has a shape, so that without all of these nothing is left to show.
    fn has_shape(self) -> bool {
        self == Self::MESH || self == Self::PRIMITIVE
    }
}

/// The parts of a file that are left out so far.
#[derive(Default)]
pub struct LeftOut {
    faults: Vec<Fault>,
    /// Indices into `faults`, so that thousands of parts with one reason are one warning.
    known: HashMap<(Part, String), usize>,
}

/// Parts of one kind that are left out for one reason.
struct Fault {
    part: Part,
    problem: Problem,
    /// Places of the first of them, [`MOST_NAMED`] and one more at most.
    places: Vec<String>,
    count: usize,
}

impl LeftOut {
    /// The value that has been read; `None`, and a part more that is left out, if it could not be.
    pub fn unless<T>(&mut self, part: Part, place: &str, read: Result<T, Problem>) -> Option<T> {
        read.map_err(|problem| self.add(part, place, problem)).ok()
    }

    /// Leaves out the part at a place of the file.
    pub fn add(&mut self, part: Part, place: &str, problem: Problem) {
        self.merge(Fault { part, problem, places: vec![place.to_owned()], count: 1 });
    }

    /// Adds the parts that another reader has left out.
    pub fn append(&mut self, other: Self) {
        other.faults.into_iter().for_each(|fault| self.merge(fault));
    }

    fn merge(&mut self, fault: Fault) {
        match self.known.get(&(fault.part, fault.problem.reason())) {
            None => {
                self.known.insert((fault.part, fault.problem.reason()), self.faults.len());
                self.faults.push(fault);
            }
            Some(&at) => {
                let known = &mut self.faults[at];
                known.count += fault.count;
                for place in fault.places {
                    if known.places.len() <= MOST_NAMED && !known.places.contains(&place) {
                        known.places.push(place);
                    }
                }
            }
        }
    }

    /// The reason for which nothing is left to show, if shapes were left out.
    pub fn into_cause(self) -> Option<Problem> {
        self.faults.into_iter().find(|fault| fault.part.has_shape()).map(|fault| fault.problem)
    }

    /// A sentence for each reason, and what to do.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let more: usize = self.faults.iter().skip(MOST_TOLD).map(|fault| fault.count).sum();
        let rest = (more > 0).then(|| format!("{more} more parts are left out, for other reasons."));
        self.faults.iter().take(MOST_TOLD).map(Fault::sentence).chain(rest)
    }
}

impl Fault {
    fn sentence(&self) -> String {
        let Part { noun, fate, remedy } = self.part;
        let reason = self.problem.reason();
        let is_new = |place: &&str| !reason.contains(place);
        let mut named: Vec<&str> = self.places.iter().map(String::as_str).filter(is_new).collect();
        if let Some(last) = named.get_mut(MOST_NAMED) {
            *last = "others";
        }
        let subject = if named.is_empty() { String::new() } else { format!("{}: ", named.join(", ")) };
        let parts = match self.count {
            1 => format!("the {noun} is {fate}"),
            count if noun.ends_with("sh") => format!("{count} such {noun}es are {fate}"),
            count => format!("{count} such {noun}s are {fate}"),
        };
        let remedy = self.problem.remedy().unwrap_or(remedy);
        format!("{subject}{reason}; {parts}. {remedy}").trim_end().to_owned()
    }
}
