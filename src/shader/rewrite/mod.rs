//! Changes of single values in source files: defaults of `//@ui` parameters and constants, and numbers. All other bytes of a file
//! stay as they are: byte order mark, line ends, comments and white space.

mod defaults;
mod literals;

use std::ops::Range;

use crate::shader::source::TreePath;

pub use defaults::defaults;
pub use literals::{Literal, literals, literals_by_line, spelled_like};

/// A change of a part of one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The file.
    pub path: TreePath,
    /// The display name of the parameter, constant or number that is changed.
    pub name: String,
    /// From 1.
    pub line: u32,
    /// The bytes of the line that are replaced.
    pub bytes: Range<usize>,
    /// The whole line before, without its line break.
    pub before: String,
    /// The new text of the bytes.
    pub new: String,
}

impl Edit {
    /// The text that is replaced; empty if text is only added.
    pub fn old(&self) -> &str {
        self.before.get(self.bytes.clone()).unwrap_or_default()
    }
}

/// The bytes of a file with edits.
///
/// # Errors
/// A message if a line is not as the edit expects it: the file has changed since. It continues "FILE ...".
pub fn applied<'e>(bytes: &[u8], edits: impl IntoIterator<Item = &'e Edit>) -> Result<Vec<u8>, String> {
    const MARK: &[u8] = b"\xef\xbb\xbf";
    let mark = if bytes.starts_with(MARK) { MARK.len() } else { 0 };
    let breaks = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1);
    let starts: Vec<usize> = std::iter::once(mark).chain(breaks).collect();
    let mut edits: Vec<&Edit> = edits.into_iter().collect();
    edits.sort_by_key(|edit| (edit.line, edit.bytes.start));
    let mut out = bytes.to_vec();
    for edit in edits.into_iter().rev() {
        let changed = || format!("has changed in line {}, so nothing was written", edit.line);
        let start = (edit.line as usize).checked_sub(1).and_then(|index| starts.get(index)).ok_or_else(changed)?;
        let whole = bytes.get(*start..*start + edit.before.len()).filter(|line| *line == edit.before.as_bytes());
        let after = bytes.get(*start + edit.before.len()..).unwrap_or_default();
        let is_whole = after.is_empty() || after.starts_with(b"\n") || after.starts_with(b"\r\n");
        whole.filter(|_| is_whole).ok_or_else(changed)?;
        out.splice(*start + edit.bytes.start..*start + edit.bytes.end, edit.new.bytes());
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_value_changes() {
        let edit = |line, bytes: Range<usize>, before: &str, new: &str| Edit {
            path: "a.glsl".into(),
            name: String::new(),
            line,
            bytes,
            before: before.to_owned(),
            new: new.to_owned(),
        };
        let bytes = b"\xef\xbb\xbfa = 1;\r\nb = 2; c = 3; // \xc3\xa4\r\n\tx";
        let edits = [
            edit(1, 4..5, "a = 1;", "10"),
            edit(2, 4..5, "b = 2; c = 3; // ä", "20"),
            edit(2, 11..12, "b = 2; c = 3; // ä", "30"),
            edit(3, 2..2, "\tx", "y"),
        ];
        let expected = b"\xef\xbb\xbfa = 10;\r\nb = 20; c = 30; // \xc3\xa4\r\n\txy";
        assert_eq!(applied(bytes, &edits).unwrap(), expected);
        assert!(applied(b"a = 2;", &edits[..1]).unwrap_err().contains("line 1"));
        assert!(applied(b"a = 1; more", &edits[..1]).is_err());
        assert!(applied(b"a = 1;", &edits[1..]).is_err());
    }
}
