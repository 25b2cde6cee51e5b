//! Names of the elements that statements store to by computed indices: `list[2]` for `list[i]`.

use std::collections::{HashMap, HashSet};

use super::TracedStage;
use super::log::LoggedEvent;
use crate::shader::spirv::trace::{INDEX, LogPoint};

/// Most elements of a statement that have names of their own. A loop over an array has one name.
const MOST: usize = 4;

/// The elements to which the log points of an invocation store. `None`: too many, or not all are known.
pub(super) struct Elements<'a> {
    stage: &'a TracedStage,
    of_points: HashMap<u32, Option<HashSet<Vec<u32>>>>,
}

impl<'a> Elements<'a> {
    /// The elements of an invocation's events.
    pub(super) fn new(stage: &'a TracedStage, events: &[LoggedEvent]) -> Self {
        let mut of_points: HashMap<u32, Option<HashSet<Vec<u32>>>> = HashMap::new();
        for event in events {
            if let Some(point) = stage.point(event.point).filter(|point| point.indices > 0) {
                let elements = of_points.entry(event.point).or_insert_with(|| Some(HashSet::new()));
                if let Some(known) = elements {
                    known.insert(indices(point, &event.bits).to_vec());
                }
                elements.take_if(|known| event.lost > 0 || known.len() > MOST);
            }
        }
        Self { stage, of_points }
    }

    /// Puts the indices of an event into its name.
    pub(super) fn complete(&self, name: &mut String, event: &LoggedEvent) {
        let is_few = self.of_points.get(&event.point).is_some_and(Option::is_some);
        let Some(point) = self.stage.point(event.point).filter(|_| is_few) else { return };
        for index in indices(point, &event.bits) {
            *name = name.replacen(INDEX, &format!("[{}]", index.cast_signed()), 1);
        }
    }
}

/// The computed indices in the bits of an event.
fn indices<'a>(point: &LogPoint, bits: &'a [u32; 4]) -> &'a [u32] {
    &bits[point.count as usize..(point.count + point.indices) as usize]
}
