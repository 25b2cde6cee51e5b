//! Counts how often the log points of each file stand in a module once a driver has inlined all calls.

use std::collections::BTreeMap;

use foldhash::{HashMap, HashSet};

use super::{LogPoint, Place};
use crate::shader::spirv::module::{Id, Module};
use crate::shader::spirv::op::Op;

/// How often the log points of each file stand in an instrumented module, which may have been specialized since, if every call is replaced by
/// its callee: calls of `function`, and of those whose names begin with it. Files whose points were all dropped are left out.
pub fn instances(words: &[u32], function: &str, places: &[Place], points: &[LogPoint]) -> BTreeMap<String, usize> {
    count(words, function, places, points).unwrap_or_default()
}

fn count(words: &[u32], function: &str, places: &[Place], points: &[LogPoint]) -> Option<BTreeMap<String, usize>> {
    let module = Module::parse(words)?;
    let logs: HashSet<Id> = module.named(function).collect();
    let entry = module.entry_function()?;
    let mut copies: HashMap<Id, usize> = HashMap::from_iter([(entry, 1)]);
    let mut found = BTreeMap::new();
    // Callers first: their copies decide about those of their callees.
    for place in module.callees_first(entry)?.into_iter().rev() {
        let caller = &module.functions[place];
        let copies_of_caller = copies.get(&caller.id).copied().unwrap_or(0);
        for i in caller.body().filter(|i| i.op == Op::FunctionCall) {
            let callee = module[i][3];
            let of_callee = copies.entry(callee).or_default();
            *of_callee = of_callee.saturating_add(copies_of_caller);
            let point = module[i].get(4).filter(|_| logs.contains(&callee)).and_then(|point| module.number(*point));
            let point = point.and_then(|number| points.get((number as usize).checked_sub(1)?));
            if let Some(place) = point.and_then(|point| places.get(point.place)).filter(|place| place.line > 0) {
                let of_file: &mut usize = found.entry(place.file.clone()).or_default();
                *of_file = of_file.saturating_add(copies_of_caller);
            }
        }
    }
    Some(found)
}
