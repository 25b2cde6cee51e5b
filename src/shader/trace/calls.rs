//! The calls of functions that are under way.

use std::collections::HashMap;
use std::sync::Arc;

/// The functions that have begun and not ended.
#[derive(Default)]
pub(super) struct Calls {
    open: Vec<Call>,
    path: Option<Arc<str>>,
}

struct Call {
    /// Name, and how often its caller has called it so far.
    name: String,
    number: usize,
    /// How often it has called each function.
    called: HashMap<String, usize>,
}

impl Calls {
    /// A function begins.
    pub(super) fn enter(&mut self, name: &str) {
        let number = self.open.last_mut().map_or(1, |caller| {
            let number = caller.called.entry(name.to_owned()).or_default();
            *number += 1;
            *number
        });
        self.open.push(Call { name: name.to_owned(), number, called: HashMap::new() });
        self.path = None;
    }

    /// The innermost function ends.
    pub(super) fn leave(&mut self) {
        self.open.pop();
        self.path = None;
    }

    /// The calls, outermost first. Its own `main` is left out, and so is the number of a first call.
    pub(super) fn path(&mut self) -> Arc<str> {
        let text = |call: &Call| match call.number {
            1 => call.name.clone(),
            number => format!("{} [{number}]", call.name),
        };
        let open = &self.open;
        let path = || open.iter().skip(1).map(text).collect::<Vec<_>>().join(" > ").into();
        self.path.get_or_insert_with(path).clone()
    }
}

/// Whether a path of calls is another, leads to it, or begins with it.
pub fn is_related(path: &str, other: &str) -> bool {
    let leads = |a: &str, b: &str| a.is_empty() || b.strip_prefix(a).is_some_and(|rest| rest.starts_with(" > "));
    path == other || leads(path, other) || leads(other, path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_are_numbered_by_their_caller() {
        let mut calls = Calls::default();
        calls.enter("specula_main");
        calls.enter("shade");
        let mut paths = Vec::new();
        for _ in 0..2 {
            calls.enter("add_light");
            calls.enter("ndf");
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
