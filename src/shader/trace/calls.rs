//! The paths of the calls of functions that were logged.

use std::collections::HashMap;
use std::sync::Arc;

use super::log::LoggedCall;
use crate::shader::spirv::trace::LightList;

/// Stands between a call and one that it makes.
const SEPARATOR: &str = " > ";
/// Stands for calls of which the log has not been kept.
const LOST: &str = "…";
/// Stands before the number of a call's light, and of its sun.
const LIGHT: &str = " [light ";
const SUN: &str = " [sun ";

/// The paths of calls.
#[derive(Default)]
pub(super) struct Calls(HashMap<u32, Arc<str>>);

/// A caller, the function that it calls, and the light that the call is about.
type Called<'a> = (u32, &'a str, Option<(LightList, u32)>);

impl Calls {
    /// Those of a log. `function`: the name of the function that begins at a log point, and the lights that one of its arguments numbers.
    pub(super) fn new<'a>(
        calls: &[LoggedCall],
        function: impl Fn(u32) -> Option<(&'a str, Option<LightList>)>,
    ) -> Self {
        let mut paths: HashMap<u32, Arc<str>> = HashMap::new();
        // How often each call has called each function for each light.
        let mut called: HashMap<Called<'_>, usize> = HashMap::new();
        // The first call behind those that are lost, and the call before the next.
        let (mut behind, mut last) = (0, 0);
        for call in calls {
            if call.number != last + 1 {
                behind = call.number;
            }
            last = call.number;
            let Some((name, list)) = function(call.point) else { continue };
            let light = list.map(|list| (list, call.light));
            let number = called.entry((call.caller, name, light)).or_default();
            *number += 1;
            // Among the lost calls may be some by the same caller.
            let number = if call.lost > 0 && call.caller < behind { Err(call.number) } else { Ok(*number) };
            let text = text(name, light, number);
            let path = match paths.get(&call.caller) {
                // Its own `main` is left out.
                _ if call.caller == 0 => "".into(),
                Some(caller) if caller.is_empty() => text.into(),
                Some(caller) => format!("{caller}{SEPARATOR}{text}").into(),
                None => format!("{LOST}{SEPARATOR}{text}").into(),
            };
            paths.insert(call.number, path);
        }
        Self(paths)
    }

    /// The calls that led to an event in a call, outermost first. The number of a first call is left out.
    pub(super) fn path(&self, call: u32) -> Arc<str> {
        match self.0.get(&call) {
            Some(path) => path.clone(),
            None if call == 0 => "".into(),
            None => format!("{LOST}{SEPARATOR}call {call}").into(),
        }
    }
}

/// A call as `add_light [light 2]`: the name, the light that it is about, from 0, and its number among the same calls by its caller. If that is
/// not known, its number among all calls.
fn text(name: &str, light: Option<(LightList, u32)>, number: Result<usize, u32>) -> String {
    // From 1, as settings and panels number lights.
    let light = light.map(|(list, index)| match list {
        LightList::Lights => format!("light {}", u64::from(index) + 1),
        LightList::Suns => format!("sun {}", u64::from(index) + 1),
    });
    match (light, number) {
        (None, Ok(1)) => name.to_owned(),
        (None, Ok(number)) => format!("{name} [{number}]"),
        (None, Err(number)) => format!("{name} [call {number}]"),
        (Some(light), Ok(1)) => format!("{name} [{light}]"),
        (Some(light), Ok(number)) => format!("{name} [{light}, {number}]"),
        (Some(light), Err(number)) => format!("{name} [{light}, call {number}]"),
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

    /// Calls with these numbers, callers, functions and lights. `lost`: a function of which calls are missing.
    fn calls(calls: &[(u32, u32, u32, u32)], lost: Option<u32>) -> Calls {
        let call = |&(number, caller, point, light)| {
            let lost = u32::from(lost == Some(point));
            LoggedCall { number, caller, point, light, lost }
        };
        let calls: Vec<LoggedCall> = calls.iter().map(call).collect();
        let [lights, suns] = [LightList::Lights, LightList::Suns].map(Some);
        Calls::new(&calls, |point| {
            let all = [("specula_main", None), ("shade", None), ("ndf", None), ("add_light", None)];
            let of_lights = [("add_light", lights), ("add_light", suns)];
            all.into_iter().chain(of_lights).nth(point as usize)
        })
    }

    #[test]
    fn calls_are_numbered_by_their_caller() {
        let all = [(1, 0, 0, 0), (2, 1, 1, 0), (3, 2, 3, 0), (4, 3, 2, 0), (5, 2, 3, 0), (6, 5, 2, 0), (7, 5, 2, 0)];
        let calls = calls(&all, None);
        let paths: Vec<Arc<str>> = (0..=7).map(|call| calls.path(call)).collect();
        let expected = [
            "",
            "",
            "shade",
            "shade > add_light",
            "shade > add_light > ndf",
            "shade > add_light [2]",
            "shade > add_light [2] > ndf",
            "shade > add_light [2] > ndf [2]",
        ];
        assert_eq!(paths.iter().map(|path| &**path).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn calls_name_the_light_that_they_are_about() {
        let about = [(4, 1), (5, 0), (4, 0), (4, 1), (4, u32::MAX), (3, 0)];
        let mut all = vec![(1, 0, 0, 0)];
        for (at, (function, light)) in (0..).zip(about) {
            all.extend([(2 + 2 * at, 1, function, light), (3 + 2 * at, 2 + 2 * at, 2, 0)]);
        }
        let calls = calls(&all, None);
        let paths: [Arc<str>; 6] = std::array::from_fn(|at| calls.path(3 + 2 * at as u32));
        let lights = ["[light 2]", "[sun 1]", "[light 1]", "[light 2, 2]", "[light 4294967296]", ""];
        let expected = lights.map(|light| format!("add_light {light}").trim_end().to_owned() + " > ndf");
        assert_eq!(paths.each_ref().map(|path| path.to_string()), expected);
        assert_eq!(paths.each_ref().map(|path| light_of(path)), [Some(2), None, Some(1), Some(2), Some(1 << 32), None]);
        assert_eq!(paths_to(&paths[0]).collect::<Vec<_>>(), ["add_light [light 2]", "add_light [light 2] > ndf"]);
        assert_eq!((paths_to("").count(), last_call(&paths[0])), (0, ("ndf", 1)));
    }

    /// Calls 4 to 8 are lost: `shade` may have made any of them. Some are of `add_light`.
    #[test]
    fn calls_behind_lost_ones_have_their_number_among_all() {
        let all = [(1, 0, 0, 0), (2, 1, 1, 0), (3, 2, 4, 0), (9, 2, 4, 1), (10, 9, 2, 0), (11, 5, 2, 0), (12, 2, 3, 0)];
        let calls = calls(&all, Some(4));
        let paths = [3, 6, 9, 10, 11, 12].map(|call| calls.path(call).to_string());
        let expected = [
            "shade > add_light [light 1]",
            "… > call 6",
            "shade > add_light [light 2, call 9]",
            "shade > add_light [light 2, call 9] > ndf",
            "… > ndf",
            "shade > add_light",
        ];
        assert_eq!(paths, expected);
        assert_eq!(light_of(&paths[3]), Some(2));
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
