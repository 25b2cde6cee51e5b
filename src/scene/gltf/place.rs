//! Places in the file, for messages, and indices that are checked.

use gltf::json;

use crate::scene::error::Problem;

/// Largest coordinate of a mesh and of the scene, in meters. The square of the camera's distance is then still finite in `f32`.
pub const LARGEST_COORDINATE: f32 = 1e15;

/// The name of an object in messages: `materials[3] "Visor"`.
pub fn place(kind: &str, index: usize, name: Option<&str>) -> String {
    // Nearly all names are plain, and a place is made for each object of the file.
    let is_plain = |byte: u8| (b' '..=b'~').contains(&byte) && !matches!(byte, b'"' | b'\'' | b'\\');
    match name {
        Some(name) if !name.is_empty() && name.bytes().all(is_plain) => format!("{kind}[{index}] \"{name}\""),
        Some(name) if !name.is_empty() => format!("{kind}[{index}] \"{}\"", name.escape_debug()),
        _ => format!("{kind}[{index}]"),
    }
}

/// An index beyond the end of a list. `place` names the object that holds the index.
pub fn out_of_range(place: &str, kind: &str, index: usize, count: usize) -> Problem {
    let expected = if count == 0 {
        format!("no use of {kind}, of which there are none")
    } else {
        format!("an index into {kind} of 0 to {}", count - 1)
    };
    Problem::invalid(place, expected, index.to_string())
}

/// Looks up an index. `place` names the object that holds the index, for the message.
pub fn get<'a, T>(items: &'a [T], index: json::Index<T>, place: &str, kind: &str) -> Result<&'a T, Problem> {
    items.get(index.value()).ok_or_else(|| out_of_range(place, kind, index.value(), items.len()))
}
