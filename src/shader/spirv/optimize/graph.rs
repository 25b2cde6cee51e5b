//! Control flow of a function: predecessors, dominators, and the constructs that blocks are in.

use foldhash::HashMap;

use crate::shader::spirv::fold::places;
use crate::shader::spirv::module::{Block, Id, Module};

const NONE: usize = usize::MAX;

/// The control flow graph of some blocks, of which the first is the entry.
pub(super) struct Graph {
    /// Places of blocks by label.
    pub(super) at: HashMap<Id, usize>,
    /// The reachable predecessors of each block, without duplicates.
    pub(super) before: Vec<Vec<usize>>,
    /// Reachable blocks in reverse postorder: a block comes after its predecessors, unless these close a loop.
    pub(super) order: Vec<usize>,
    /// The interval of each block's subtree in the dominator tree; empty for unreachable blocks.
    spans: Vec<(usize, usize)>,
}

impl Graph {
    pub(super) fn new(module: &Module, blocks: &[Block]) -> Self {
        let at = places(blocks);
        let targets = |block: &Block| block.targets(module).filter_map(|id| at.get(&id).copied()).collect::<Vec<_>>();
        let after: Vec<Vec<usize>> = blocks.iter().map(targets).collect();
        let order = reverse_postorder(&after);
        let mut before = vec![Vec::new(); blocks.len()];
        for &from in &order {
            for &to in &after[from] {
                if !before[to].contains(&from) {
                    before[to].push(from);
                }
            }
        }
        let spans = spans(&order, &before);
        Self { at, before, order, spans }
    }

    /// Whether every path to `b` goes through `a`. False if one of them is unreachable.
    pub(super) fn dominates(&self, a: usize, b: usize) -> bool {
        let ((first, end), (place, place_end)) = (self.spans[a], self.spans[b]);
        first < end && place < place_end && (first..end).contains(&place)
    }

    /// Whether a block is in the construct between a header and its merge block.
    pub(super) fn is_within(&self, header: usize, merge: Id, block: usize) -> bool {
        let merge = self.at.get(&merge);
        self.dominates(header, block) && !merge.is_some_and(|merge| self.dominates(*merge, block))
    }
}

fn reverse_postorder(after: &[Vec<usize>]) -> Vec<usize> {
    let (mut seen, mut order) = (vec![false; after.len()], Vec::new());
    let mut open: Vec<(usize, usize)> = Vec::new();
    if let Some(first) = seen.first_mut() {
        *first = true;
        open.push((0, 0));
    }
    while let Some((block, next)) = open.last_mut() {
        match after[*block].get(*next) {
            Some(&to) => {
                *next += 1;
                if !std::mem::replace(&mut seen[to], true) {
                    open.push((to, 0));
                }
            }
            None => {
                order.push(*block);
                open.pop();
            }
        }
    }
    order.reverse();
    order
}

/// The dominator tree (Cooper, Harvey & Kennedy 2001) as intervals: a block dominates the blocks whose interval is within its own.
fn spans(order: &[usize], before: &[Vec<usize>]) -> Vec<(usize, usize)> {
    let mut rank = vec![NONE; before.len()];
    for (place, block) in order.iter().enumerate() {
        rank[*block] = place;
    }
    // Immediate dominators, all by their place in `order`.
    let mut parent = vec![NONE; order.len()];
    if let Some(root) = parent.first_mut() {
        *root = 0;
    }
    let mut is_changed = true;
    while is_changed {
        is_changed = false;
        for (place, block) in order.iter().enumerate().skip(1) {
            let known = before[*block].iter().map(|from| rank[*from]).filter(|from| parent[*from] != NONE);
            let common = known.reduce(|mut a, mut b| {
                while a != b {
                    match a > b {
                        true => a = parent[a],
                        false => b = parent[b],
                    }
                }
                a
            });
            let common = common.unwrap_or(NONE);
            is_changed |= parent[place] != common;
            parent[place] = common;
        }
    }
    // A subtree's size is known once all later blocks have been added to their parents. Then intervals follow from the root.
    let mut sizes = vec![1; order.len()];
    for place in (1..order.len()).rev() {
        sizes[parent[place]] += sizes[place];
    }
    let (mut starts, mut used) = (vec![0; order.len()], vec![1; order.len()]);
    for place in 1..order.len() {
        let above = parent[place];
        starts[place] = starts[above] + used[above];
        used[above] += sizes[place];
    }
    let mut spans = vec![(0, 0); before.len()];
    for (place, block) in order.iter().enumerate() {
        spans[*block] = (starts[place], starts[place] + sizes[place]);
    }
    spans
}
