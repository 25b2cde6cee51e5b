//! Control flow that does nothing: branches on known values, selections without content, chains of blocks.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::graph::Graph;
use super::module::Module;
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::specialize::control_flow::{Block, Function};
use crate::shader::spirv::specialize::{Id, instruction, opcode};

/// Takes branches that constants decide.
pub(super) fn fold(module: &Module, function: &mut Function) {
    function.fold(&module.known, &mut HashSet::new());
}

/// Replaces phis of blocks that only one reachable block leads to. The way that folding has cut off may be the back edge of a loop,
/// whose block the structure of the loop still requires.
pub(super) fn drop_single_phis(module: &mut Module, function: &mut Function) {
    let graph = Graph::new(&function.blocks);
    for block in 0..function.blocks.len() {
        let [before] = *graph.before[block] else { continue };
        let label = function.blocks[before].label;
        function.blocks[block].body.retain(|i| {
            let pairs = i.get(3..).unwrap_or_default().chunks_exact(2);
            let value = pairs.filter(|pair| pair[1] == label).map(|pair| pair[0]).next();
            match value {
                Some(value) if opcode(i) == op::PHI => {
                    module.replace(i[2], value);
                    false
                }
                _ => true,
            }
        });
    }
}

/// Removes selections that select nothing, and joins blocks that follow each other.
pub(super) fn tidy(function: &mut Function) {
    loop {
        let is_changed = drop_single_cases(function) | drop_empty_selections(function);
        if is_changed {
            function.drop_unreached(&mut HashSet::new());
        }
        if !(is_changed | join_blocks(function)) {
            return;
        }
    }
}

/// Replaces a switch with one target by a branch, if nothing breaks out of it.
fn drop_single_cases(function: &mut Function) -> bool {
    let is_single = |block: &Block| block.body.last().is_some_and(|i| opcode(i) == op::SWITCH && i.len() == 3);
    if !function.blocks.iter().any(is_single) {
        return false;
    }
    let graph = Graph::new(&function.blocks);
    let mut dropped = Vec::new();
    for (header, block) in function.blocks.iter().enumerate().filter(|(_, block)| is_single(block)) {
        let (Some(merge), _) = block.structure() else { continue };
        let Some(ends) = graph.at.get(&merge).map(|merge| &*graph.before[*merge]) else { continue };
        let is_nested = |end: usize| {
            let inner = function.blocks.iter().enumerate().filter(|(inner, _)| *inner != header);
            let mut inner = inner.filter_map(|(place, block)| Some((place, block.structure().0?)));
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
        let target = body.pop().map_or(0, |i| i[2]);
        body.pop();
        body.push(instruction(op::BRANCH, &[target]));
    }
    !dropped.is_empty()
}

/// Replaces a selection by a branch to its end, if both ways lead straight there.
fn drop_empty_selections(function: &mut Function) -> bool {
    // Blocks that only lead on, and where to.
    let leads = |block: &Block| match &*block.body {
        [i] if opcode(i) == op::BRANCH => Some((block.label, i[1])),
        _ => None,
    };
    let leading: HashMap<Id, Id> = function.blocks.iter().filter_map(leads).collect();
    let is_phi = |block: &&Block| block.body.first().is_some_and(|i| opcode(i) == op::PHI);
    let with_phis: HashSet<Id> = function.blocks.iter().filter(is_phi).map(|block| block.label).collect();
    let mut is_changed = false;
    for block in &mut function.blocks {
        let (Some(merge), None) = block.structure() else { continue };
        let is_branch = block.body.last().is_some_and(|i| opcode(i) == op::BRANCH_CONDITIONAL);
        let ends = |target: &Id| *target == merge || leading.get(target) == Some(&merge);
        if is_branch && !with_phis.contains(&merge) && block.targets().iter().all(ends) {
            block.body.pop();
            block.body.pop();
            block.body.push(instruction(op::BRANCH, &[merge]));
            is_changed = true;
        }
    }
    is_changed
}

/// Appends each block to the one that leads to it alone.
fn join_blocks(function: &mut Function) -> bool {
    let mut sources: HashMap<Id, usize> = HashMap::new();
    let mut structural: HashSet<Id> = HashSet::new();
    for block in &function.blocks {
        for target in block.targets() {
            *sources.entry(target).or_default() += 1;
        }
        let (merge, next) = block.structure();
        structural.extend(merge);
        structural.extend(next);
    }
    let at: HashMap<Id, usize> =
        function.blocks.iter().enumerate().map(|(index, block)| (block.label, index)).collect();
    let mut joined: HashMap<Id, Id> = HashMap::new();
    for index in 0..function.blocks.len() {
        while let Some(last) = function.blocks[index].body.last() {
            if opcode(last) != op::BRANCH || function.blocks[index].structure().0.is_some() {
                break;
            }
            let target = last[1];
            let Some(&next) = at.get(&target).filter(|next| **next != index && **next != 0) else { break };
            let is_phi = function.blocks[next].body.first().is_none_or(|i| opcode(i) == op::PHI);
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
    for i in function.blocks.iter_mut().flat_map(|block| &mut block.body).filter(|i| opcode(i) == op::PHI) {
        i[3..].iter_mut().skip(1).step_by(2).for_each(|from| *from = first(from));
    }
    true
}
