//! Names of files with a `*`, which stands for the faces of a cube map, or for layers and slices.

/// The sets of names that files of a cube map's faces may have, each in the order +X -X +Y -Y +Z -Z.
pub const FACES: [[&str; 6]; 5] = [
    ["px", "nx", "py", "ny", "pz", "nz"],
    ["posx", "negx", "posy", "negy", "posz", "negz"],
    ["0", "1", "2", "3", "4", "5"],
    // Of editors' Shadertoy extensions.
    ["e", "w", "u", "d", "n", "s"],
    ["east", "west", "up", "down", "north", "south"],
];

/// A file name with one `*`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern<'a> {
    before: &'a str,
    after: &'a str,
}

impl<'a> Pattern<'a> {
    /// The pattern in the last part of a path. `None` if it has no `*`.
    pub fn of(path: &'a str) -> Option<Self> {
        let name = path.rsplit('/').next()?;
        name.split_once('*').map(|(before, after)| Self { before, after })
    }

    /// The name with `part` in place of the `*`.
    pub fn with(&self, part: &str) -> String {
        format!("{}{part}{}", self.before, self.after)
    }

    /// The text at the place of the `*`, if `name` matches. It has at least one character.
    pub fn part<'n>(&self, name: &'n str) -> Option<&'n str> {
        name.strip_prefix(self.before)?.strip_suffix(self.after).filter(|part| !part.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_a_part_of_a_name() {
        let pattern = Pattern::of("a/sky_*.png").unwrap();
        assert_eq!(pattern.with("px"), "sky_px.png");
        assert_eq!(pattern.part("sky_nz.png"), Some("nz"));
        assert_eq!(["sky_.png", "sky_px.jpg", "ski_px.png", "sky_.pn"].map(|name| pattern.part(name)), [None; 4]);
        assert_eq!(Pattern::of("sk*/sky.png"), None);
    }
}
