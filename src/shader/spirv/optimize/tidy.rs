//! Control flow that does nothing: branches on known values, selections without content, chains of blocks.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::graph::Graph;
use super::optimizer::Optimizer;
use crate::shader::spirv::fold::{self, drop_unreached, places};
use crate::shader::spirv::module::{Block, Function, Id, Module};
use crate::shader::spirv::op::Op;

/// Takes branches that known values decide.
pub(super) fn fold(Optimizer { module, known, .. }: &mut Optimizer, function: &mut Function) {
    fold::fold(module, function, known, &HashMap::new(), &mut HashSet::new());
}

/// Replaces phis of blocks that only one reachable block leads to. The way that folding has cut off may be the back edge of a loop,
/// whose block the structure of the loop still requires.
pub(super) fn drop_single_phis(optimizer: &mut Optimizer, function: &mut Function) {
    let graph = Graph::new(&optimizer.module, &function.blocks);
    for block in 0..function.blocks.len() {
        let [before] = *graph.before[block] else { continue };
        let label = function.blocks[before].label;
        function.blocks[block].body.retain(|i| {
            if i.op != Op::Phi {
                return true;
            }
            let words = &optimizer.module[*i];
            let id = words[2];
            let value = words[3..].chunks_exact(2).find(|pair| pair[1] == label).map(|pair| pair[0]);
            value.into_iter().for_each(|value| optimizer.replace(id, value));
            value.is_none()
        });
    }
}

/// Removes selections that select nothing, and joins blocks that follow each other. Returns whether there were such selections.
pub(super) fn tidy(module: &mut Module, function: &mut Function) -> bool {
    let mut has_dropped = false;
    loop {
        let is_changed = drop_single_cases(module, function) | drop_empty_selections(module, function);
        if is_changed {
            drop_unreached(module, function, &mut HashSet::new());
        }
        has_dropped |= is_changed;
        if !(is_changed | join_blocks(module, function)) {
            return has_dropped;
        }
    }
}

/// Replaces a switch with one target by a branch, if nothing breaks out of it.
fn drop_single_cases(module: &mut Module, function: &mut Function) -> bool {
    let is_single = |block: &Block| block.end().is_some_and(|i| i.op == Op::Switch && module[i].len() == 3);
    if !function.blocks.iter().any(is_single) {
        return false;
    }
    let graph = Graph::new(module, &function.blocks);
    let mut dropped = Vec::new();
    for (header, block) in function.blocks.iter().enumerate().filter(|(_, block)| is_single(block)) {
        let (Some(merge), _) = block.structure(module) else { continue };
        let Some(ends) = graph.at.get(&merge).map(|merge| &*graph.before[*merge]) else { continue };
        let is_nested = |end: usize| {
            let inner = function.blocks.iter().enumerate().filter(|(inner, _)| *inner != header);
            let mut inner = inner.filter_map(|(place, block)| Some((place, block.structure(module).0?)));
            inner.any(|(place, merge)| graph.dominates(header, place) && graph.is_within(place, merge, end))
        };
        match ends {
            [] => dropped.push(header),
            [end] if !is_nested(*end) => dropped.push(header),
            _ => {}
        }
    }
    for header in &dropped {
        let body = &mut function.blocks[*header].body;
        let target = body.pop().map_or(0, |i| module[i][2]);
        body.pop();
        body.push(module.make(Op::Branch, &[target]));
    }
    !dropped.is_empty()
}

/// Replaces a selection by a branch to its end, if both ways lead straight there.
fn drop_empty_selections(module: &mut Module, function: &mut Function) -> bool {
    // Blocks that only lead on, and where to.
    let leads = |block: &Block| match &*block.body {
        [i] if i.op == Op::Branch => Some((block.label, module[*i][1])),
        _ => None,
    };
    let leading: HashMap<Id, Id> = function.blocks.iter().filter_map(leads).collect();
    let is_phi = |block: &&Block| block.body.first().is_some_and(|i| i.op == Op::Phi);
    let with_phis: HashSet<Id> = function.blocks.iter().filter(is_phi).map(|block| block.label).collect();
    let mut is_changed = false;
    for block in &mut function.blocks {
        let (Some(merge), None) = block.structure(module) else { continue };
        let is_branch = block.ends_with(Op::BranchConditional);
        let ends = |target: &Id| *target == merge || leading.get(target) == Some(&merge);
        if is_branch && !with_phis.contains(&merge) && block.targets(module).all(|target| ends(&target)) {
            block.body.pop();
            block.body.pop();
            block.body.push(module.make(Op::Branch, &[merge]));
            is_changed = true;
        }
    }
    is_changed
}

/// Appends each block to the one that leads to it alone.
fn join_blocks(module: &mut Module, function: &mut Function) -> bool {
    let mut sources: HashMap<Id, usize> = HashMap::new();
    let mut structural: HashSet<Id> = HashSet::new();
    for block in &function.blocks {
        for target in block.targets(module) {
            *sources.entry(target).or_default() += 1;
        }
        let (merge, next) = block.structure(module);
        structural.extend(merge);
        structural.extend(next);
    }
    let at = places(&function.blocks);
    let mut joined: HashMap<Id, Id> = HashMap::new();
    for index in 0..function.blocks.len() {
        while let Some(last) = function.blocks[index].end() {
            if last.op != Op::Branch || function.blocks[index].structure(module).0.is_some() {
                break;
            }
            let target = module[last][1];
            let Some(&next) = at.get(&target).filter(|next| **next != index && **next != 0) else { break };
            let is_phi = function.blocks[next].body.first().is_none_or(|i| i.op == Op::Phi);
            if sources.get(&target) != Some(&1) || structural.contains(&target) || is_phi {
                break;
            }
            let body = std::mem::take(&mut function.blocks[next].body);
            let block = &mut function.blocks[index];
            block.body.pop();
            block.body.extend(body);
            joined.insert(target, block.label);
        }
    }
    if joined.is_empty() {
        return false;
    }
    function.blocks.retain(|block| !joined.contains_key(&block.label));
    // A chain of joined blocks ends at one that is left.
    let first = |id: &Id| {
        let mut id = *id;
        while let Some(before) = joined.get(&id) {
            id = *before;
        }
        id
    };
    for i in function.body().filter(|i| i.op == Op::Phi) {
        module[i][3..].iter_mut().skip(1).step_by(2).for_each(|from| *from = first(from));
    }
    true
}
