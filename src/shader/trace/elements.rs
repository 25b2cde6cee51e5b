//! Names of the elements that statements store to by computed indices: `list[2]` for `list[i]`.

use std::collections::{BTreeMap, BTreeSet};

use super::TracedStage;
use crate::shader::spirv::trace::{INDEX, LogPoint};

/// Most elements of a statement that have names of their own. A loop over an array has one name.
const MOST: usize = 4;

/// The elements to which the log points of an invocation store.
pub(super) struct Elements<'a> {
    stage: &'a TracedStage,
    of_points: BTreeMap<u32, BTreeSet<Vec<u32>>>,
}

impl<'a> Elements<'a> {
    /// The elements of events, which are the number of a log point and its bits.
    pub(super) fn new(stage: &'a TracedStage, events: impl Iterator<Item = (u32, [u32; 4])>) -> Self {
        let mut of_points: BTreeMap<u32, BTreeSet<Vec<u32>>> = BTreeMap::new();
        for (number, bits) in events {
            if let Some(point) = stage.point(number).filter(|point| point.indices > 0) {
                of_points.entry(number).or_default().insert(indices(point, &bits).to_vec());
            }
        }
        Self { stage, of_points }
    }

    /// Puts the indices of an event into its name.
    pub(super) fn complete(&self, name: &mut String, (number, bits): (u32, [u32; 4])) {
        let is_few = self.of_points.get(&number).is_some_and(|elements| elements.len() <= MOST);
        let Some(point) = self.stage.point(number).filter(|_| is_few) else { return };
        for index in indices(point, &bits) {
            *name = name.replacen(INDEX, &format!("[{}]", index.cast_signed()), 1);
        }
    }
}

/// The computed indices in the bits of an event.
fn indices<'a>(point: &LogPoint, bits: &'a [u32; 4]) -> &'a [u32] {
    &bits[point.count as usize..(point.count + point.indices) as usize]
}
