//! Paths of files in shader trees.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The path of a file in a shader tree: relative to the root, normalized, with forward slashes.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String")]
pub struct TreePath(String);

impl TryFrom<String> for TreePath {
    type Error = String;

    fn try_from(path: String) -> Result<Self, String> {
        Self::parse(&path).ok_or_else(|| format!("{path} is no path in a tree"))
    }
}

impl TreePath {
    /// Normalizes `.` and `..`. `None` if the path is absolute, leaves the root, or is the root itself.
    pub fn parse(path: &str) -> Option<Self> {
        if path.starts_with('/') {
            return None;
        }
        let mut parts: Vec<&str> = Vec::new();
        for part in path.split('/') {
            match part {
                "" | "." => {}
                ".." => {
                    parts.pop()?;
                }
                part => parts.push(part),
            }
        }
        if parts.is_empty() { None } else { Some(Self(parts.join("/"))) }
    }

    /// Resolves `relative` from the directory of this file. `None` if the result leaves the root.
    pub fn sibling(&self, relative: &str) -> Option<Self> {
        match self.0.rsplit_once('/') {
            Some((directory, _)) if !relative.starts_with('/') => Self::parse(&format!("{directory}/{relative}")),
            _ => Self::parse(relative),
        }
    }

    /// The path as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The text after the last dot of the file name.
    pub fn extension(&self) -> Option<&str> {
        let name = self.0.rsplit('/').next()?;
        name.rsplit_once('.').map(|(_, extension)| extension)
    }

    /// The path without its extension: `ibl/dfg` of `ibl/dfg.comp`.
    pub fn stem(&self) -> &str {
        match self.extension() {
            Some(extension) => &self.0[..self.0.len() - extension.len() - 1],
            None => &self.0,
        }
    }
}

impl From<&str> for TreePath {
    /// Converts paths in source code. A `..` that would leave the root stays at the root. Use [`TreePath::parse`], which refuses
    /// such a path, for input.
    fn from(path: &str) -> Self {
        let mut parts: Vec<&str> = Vec::new();
        for part in path.split('/') {
            match part {
                "" | "." => {}
                ".." => {
                    parts.pop();
                }
                part => parts.push(part),
            }
        }
        Self(parts.join("/"))
    }
}

impl fmt::Display for TreePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_normalized_and_stay_inside() {
        assert_eq!(TreePath::parse("a/./b//../c.glsl").map(|p| p.to_string()), Some("a/c.glsl".to_owned()));
        assert_eq!(TreePath::parse("../c.glsl"), None);
        assert_eq!(TreePath::parse("/etc/passwd"), None);
        assert_eq!(TreePath::parse("a/.."), None);
        let path = TreePath::from("brdf/ggx.glsl");
        assert_eq!(path.sibling("../common/math.glsl"), TreePath::parse("common/math.glsl"));
        assert_eq!(path.sibling("../../x.glsl"), None);
        assert_eq!(path.sibling("/x.glsl"), None);
        assert_eq!((path.stem(), path.extension()), ("brdf/ggx", Some("glsl")));
    }
}
