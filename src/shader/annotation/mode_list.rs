//! The order in which lists show the modes, and the steps through it.

use std::collections::HashSet;
use std::sync::LazyLock;

use super::mode::Mode;
use super::parse::{Annotation, parse_file};
use crate::shader::{TreePath, embedded};

/// The groups of the modes that Specula comes with.
static BUILT_IN_GROUPS: LazyLock<HashSet<String>> = LazyLock::new(|| {
    let text = embedded::read(None, &TreePath::from("debug/modes.glsl")).unwrap_or_default();
    let text = std::str::from_utf8(text).unwrap_or_default();
    let groups = parse_file("", text).0.into_iter().filter_map(|found| match found {
        Annotation::Mode(mode, _) => Some(mode.group),
        _ => None,
    });
    groups.chain(["Passes".to_owned()]).collect()
});

/// The modes in the order of lists: that of their numbers, but the author's own groups follow the first group.
pub fn listed(modes: &[Mode]) -> Vec<&Mode> {
    let first = modes.first().map(|mode| &mode.group);
    let mut listed: Vec<&Mode> = modes.iter().collect();
    listed.sort_by_key(|mode| (first != Some(&mode.group), BUILT_IN_GROUPS.contains(mode.group.as_str())));
    listed
}

/// The modes before and after `slug` in the order of [`listed`], the last before the first. Modes without data in a model with these
/// `FEATURE_*` bits are passed over. `None` without such modes.
pub fn neighbors<'a>(modes: &'a [Mode], slug: &str, features: Option<u32>) -> Option<[&'a Mode; 2]> {
    let mut listed = listed(modes);
    listed.retain(|mode| mode.slug == slug || mode.has_data(features));
    let count = listed.len();
    let at = listed.iter().position(|mode| mode.slug == slug).unwrap_or(0);
    (count > 0).then(|| [listed[(at + count - 1) % count], listed[(at + 1) % count]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(slug: &str, group: &str, needs: u32) -> Mode {
        Mode { slug: slug.into(), group: group.into(), needs, ..Mode::default() }
    }

    #[test]
    fn steps_follow_the_list_and_pass_over_modes_without_data() {
        let modes = [
            mode("final", "Result", 0),
            mode("depth", "Geometry", 0),
            mode("uv1", "Geometry", 2),
            mode("height", "Mine", 0),
            mode("width", "Mine", 0),
        ];
        let slugs = |modes: &[&Mode]| modes.iter().map(|mode| mode.slug.clone()).collect::<Vec<_>>();
        assert_eq!(slugs(&listed(&modes)), ["final", "height", "width", "depth", "uv1"]);
        let of = |slug: &str, features: Option<u32>| slugs(&neighbors(&modes, slug, features).unwrap());
        assert_eq!(of("width", Some(1)), ["height", "depth"]);
        assert_eq!(of("depth", Some(1)), ["width", "final"]);
        assert_eq!(of("depth", Some(2)), ["width", "uv1"]);
        assert_eq!(of("uv1", Some(1)), ["depth", "final"]);
        assert!(neighbors(&[], "final", None).is_none());
    }
}
