//! The source of a primitive in the file.

use gltf::json;
use json::mesh::Semantic;
use json::validation::Checked;

use super::accessor::{Format, Reader};
use crate::scene::error::Problem;
use crate::scene::gltf::motion::raw::RawTarget;

/// A primitive in the file.
pub struct Source<'a> {
    /// Reads its accessors.
    pub reader: Reader<'a>,
    /// Its JSON.
    pub primitive: &'a json::mesh::Primitive,
    /// Its morph targets.
    pub targets: &'a [RawTarget],
    /// Number of joints of the skins that it has; `None` without a skin.
    pub joints: Option<usize>,
    /// For messages.
    pub place: &'a str,
}

impl Source<'_> {
    /// Reads an attribute, if present. It must have as many elements as POSITION.
    pub fn attribute<const K: usize>(
        &self,
        semantic: Semantic,
        name: &str,
        format: &Format,
        count: Option<usize>,
    ) -> Result<Option<Vec<[f32; K]>>, Problem> {
        let Some(&accessor) = self.primitive.attributes.get(&Checked::Valid(semantic)) else {
            return Ok(None);
        };
        self.elements(accessor, &format!("{}.{name}", self.place), format, 1.0, count).map(Some)
    }

    /// Reads the accessor of an attribute. `fill` replaces missing components.
    pub fn elements<const K: usize>(
        &self,
        accessor: json::Index<json::Accessor>,
        user: &str,
        format: &Format,
        fill: f32,
        count: Option<usize>,
    ) -> Result<Vec<[f32; K]>, Problem> {
        // Check the count before reading the data.
        let found = self.reader.root.accessors.get(accessor.value()).map(|accessor| accessor.count.0);
        if let (Some(count), Some(found)) = (count, found)
            && count as u64 != found
        {
            let expected = format!("as many elements as POSITION has, {count}");
            return Err(Problem::invalid(user, expected, found.to_string()));
        }
        self.reader.floats(accessor, format, fill, user)
    }

    /// Warns of something that some elements have.
    pub fn note(&self, count: usize, what: &str, warnings: &mut Vec<String>) {
        if count > 0 {
            warnings.push(format!("{}: {count} {what}.", self.place));
        }
    }
}
