//! The calls of functions that are under way.

use std::collections::HashMap;
use std::sync::Arc;

use crate::shader::spirv::trace::LightList;

/// Stands between a call and one that it makes.
const SEPARATOR: &str = " > ";
/// Stands before the number of a call's light, and of its sun.
const LIGHT: &str = " [light ";
const SUN: &str = " [sun ";

/// The functions that have begun and not ended.
#[derive(Default)]
pub(super) struct Calls {
    open: Vec<Call>,
    path: Option<Arc<str>>,
}

struct Call {
    /// As `add_light [light 2]`: the name, the light that it is about, and its number among the same calls by its caller.
    text: String,
    /// How often it has called each function for each light.
    called: HashMap<(String, Option<(LightList, u32)>), usize>,
}

impl Calls {
    /// A function begins. `light`: the light that one of its arguments numbers, from 0.
    pub(super) fn enter(&mut self, name: &str, light: Option<(LightList, u32)>) {
        let number = self.open.last_mut().map_or(1, |caller| {
            let number = caller.called.entry((name.to_owned(), light)).or_default();
            *number += 1;
            *number
        });
        // From 1, as settings and panels number lights.
        let light = light.map(|(list, index)| match list {
            LightList::Lights => format!("light {}", u64::from(index) + 1),
            LightList::Suns => format!("sun {}", u64::from(index) + 1),
        });
        let text = match (light, number) {
            (None, 1) => name.to_owned(),
            (None, number) => format!("{name} [{number}]"),
            (Some(light), 1) => format!("{name} [{light}]"),
            (Some(light), number) => format!("{name} [{light}, {number}]"),
        };
        self.open.push(Call { text, called: HashMap::new() });
        self.path = None;
    }

    /// The innermost function ends.
    pub(super) fn leave(&mut self) {
        self.open.pop();
        self.path = None;
    }

    /// The calls, outermost first. Its own `main` is left out, and so is the number of a first call.
    pub(super) fn path(&mut self) -> Arc<str> {
        let open = &self.open;
        let path = || open.iter().skip(1).map(|call| call.text.as_str()).collect::<Vec<_>>().join(SEPARATOR).into();
        self.path.get_or_insert_with(path).clone()
    }
}

/// Whether a path of calls is another, leads to it, or begins with it.
pub fn is_related(path: &str, other: &str) -> bool {
    let leads = |a: &str, b: &str| a.is_empty() || b.strip_prefix(a).is_some_and(|rest| rest.starts_with(SEPARATOR));
    path == other || leads(path, other) || leads(other, path)
}

/// The paths of the calls that led to one, outermost first, and its own.
pub fn paths_to(path: &str) -> impl Iterator<Item = &str> {
    let ends = path.match_indices(SEPARATOR).map(|(at, _)| at).chain([path.len()]);
    ends.map(|end| &path[..end]).filter(|path| !path.is_empty())
}

/// The last call of a path, and how many calls led to it.
pub fn last_call(path: &str) -> (&str, usize) {
    (path.rsplit(SEPARATOR).next().unwrap_or_default(), path.matches(SEPARATOR).count())
}

/// The light that the last call with one in a path is about, from 1; `None` for a sun of the environment.
pub fn light_of(path: &str) -> Option<usize> {
    let last = path.rsplit(SEPARATOR).find(|call| call.contains(LIGHT) || call.contains(SUN))?;
    let (_, number) = last.split_once(LIGHT)?;
    number.split([']', ',']).next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_are_numbered_by_their_caller() {
        let mut calls = Calls::default();
        calls.enter("specula_main", None);
        calls.enter("shade", None);
        let mut paths = Vec::new();
        for _ in 0..2 {
            calls.enter("add_light", None);
            calls.enter("ndf", None);
            paths.push(calls.path().to_string());
            calls.leave();
            calls.leave();
        }
        paths.push(calls.path().to_string());
        assert_eq!(paths, ["shade > add_light > ndf", "shade > add_light [2] > ndf", "shade"]);
        (0..9).for_each(|_| calls.leave());
        assert_eq!(&*calls.path(), "");
    }

    #[test]
    fn calls_name_the_light_that_they_are_about() {
        let mut calls = Calls::default();
        calls.enter("specula_main", None);
        let mut path = |light: Option<(LightList, u32)>| {
            calls.enter("add_light", light);
            calls.enter("ndf", None);
            let path = calls.path();
            (0..2).for_each(|_| calls.leave());
            path
        };
        let [light, sun] = [LightList::Lights, LightList::Suns].map(|list| move |index: u32| Some((list, index)));
        let paths = [light(1), sun(0), light(0), light(1), light(u32::MAX), None].map(&mut path);
        let lights = ["[light 2]", "[sun 1]", "[light 1]", "[light 2, 2]", "[light 4294967296]", ""];
        let expected = lights.map(|light| format!("add_light {light}").trim_end().to_owned() + " > ndf");
        assert_eq!(paths.each_ref().map(|path| path.to_string()), expected);
        assert_eq!(paths.each_ref().map(|path| light_of(path)), [Some(2), None, Some(1), Some(2), Some(1 << 32), None]);
        assert_eq!(paths_to(&paths[0]).collect::<Vec<_>>(), ["add_light [light 2]", "add_light [light 2] > ndf"]);
        assert_eq!((paths_to("").count(), last_call(&paths[0])), (0, ("ndf", 1)));
    }

    #[test]
    fn a_call_has_what_leads_to_it_and_what_it_makes() {
        let chosen = "shade > add_light [2]";
        for (path, is) in [
            ("", true),
            ("shade", true),
            (chosen, true),
            ("shade > add_light [2] > d_ggx", true),
            ("shade > add_light", false),
            ("shade > add_light [2", false),
            ("shade > add_light [21]", false),
            ("other", false),
        ] {
            assert_eq!(is_related(path, chosen), is, "{path}");
        }
    }
}
