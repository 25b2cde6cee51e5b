//! Takes the branches of a function that known values decide, and drops the blocks that nothing reaches.
//!
//! See the SPIR-V specification, section 2.11, for the rules of structured control flow.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::evaluate::evaluate;
use super::module::{Block, Function, Id, Instruction, Module};
use super::op::Op;

/// Takes decided branches and drops unreachable blocks until nothing changes: dropping a block can decide another
/// branch. `known`: values besides the constants; `returned`: the values that functions always return. Adds to `removed` what is
/// dropped.
pub fn fold(
    module: &mut Module,
    function: &mut Function,
    known: &HashMap<Id, u32>,
    returned: &HashMap<Id, u32>,
    removed: &mut HashSet<Id>,
) {
    let mut any = false;
    while take_branches(module, function, known, returned) {
        drop_unreached(module, function, removed);
        any = true;
    }
    if any {
        sort(module, function);
    }
}

/// The places of blocks by their labels.
pub fn places(blocks: &[Block]) -> HashMap<Id, usize> {
    blocks.iter().enumerate().map(|(index, block)| (block.label, index)).collect()
}

/// Drops the names and decorations of ids that were removed.
pub fn drop_results(module: &mut Module, removed: &HashSet<Id>) {
    let (mut debug, mut decorations) = (std::mem::take(&mut module.debug), std::mem::take(&mut module.decorations));
    debug.retain(|i| i.op != Op::Name || !removed.contains(&module[*i][1]));
    decorations.retain(|i| i.op != Op::Decorate || !removed.contains(&module[*i][1]));
    (module.debug, module.decorations) = (debug, decorations);
}

/// Reorders blocks so that each follows its dominators (SPIR-V specification, section 2.4). Taking a branch can
/// change the dominators where a switch case falls through. Unreachable blocks come last.
fn sort(module: &Module, function: &mut Function) {
    let blocks = &function.blocks;
    let at = places(blocks);
    let (mut seen, mut finished) = (vec![false; blocks.len()], Vec::new());
    let mut open: Vec<(usize, bool)> = vec![(0, false)];
    while let Some((index, is_done)) = open.pop() {
        if is_done {
            finished.push(index);
        } else if !std::mem::replace(&mut seen[index], true) {
            open.push((index, true));
            let ways = blocks[index].targets(module).filter_map(|id| at.get(&id).copied());
            open.extend(ways.filter(|to| !seen[*to]).map(|to| (to, false)));
        }
    }
    let rest = (0..blocks.len()).filter(|index| !seen[*index]);
    let order: Vec<usize> = finished.into_iter().rev().chain(rest).collect();
    let mut blocks: Vec<Option<Block>> = function.blocks.drain(..).map(Some).collect();
    function.blocks = order.into_iter().filter_map(|index| blocks[index].take()).collect();
}

/// Takes all branches that known values decide; returns whether there was one.
fn take_branches(
    module: &mut Module,
    function: &mut Function,
    known: &HashMap<Id, u32>,
    returned: &HashMap<Id, u32>,
) -> bool {
    let mut local: HashMap<Id, u32> = HashMap::new();
    let mut any = false;
    // Keep the conditional branch that exits a loop, even if it is decided: a loop construct needs both a back edge
    // and an exit.
    let loops = function.blocks.iter().map(|block| block.structure(module)).filter(|(_, next)| next.is_some());
    let loop_ends: HashSet<Id> = loops.filter_map(|(merge, _)| merge).collect();
    for block in &mut function.blocks {
        let found = values(module, block, &|id| value(module, known, &local, id), returned);
        local.extend(found);
        let Some(last) = block.end() else { continue };
        let selector = module[last].get(1).and_then(|id| value(module, known, &local, *id));
        let Some(selected) = selector else { continue };
        match (last.op, &module[last]) {
            // The switch itself remains, since breaks inside need it.
            (Op::Switch, [_, selector, default, cases @ ..]) if !cases.is_empty() => {
                let case = cases.chunks_exact(2).find(|case| case[0] == selected).map_or(*default, |case| case[1]);
                let operands = [*selector, case];
                block.body.pop();
                block.body.push(module.make(Op::Switch, &operands));
            }
            (Op::BranchConditional, &[_, _, yes, no, ..]) if !loop_ends.contains(&yes) && !loop_ends.contains(&no) => {
                block.body.pop();
                block.body.pop_if(|i| i.op == Op::SelectionMerge);
                block.body.push(module.make(Op::Branch, &[if selected != 0 { yes } else { no }]));
            }
            _ => continue,
        }
        any = true;
    }
    any
}

fn value(module: &Module, known: &HashMap<Id, u32>, local: &HashMap<Id, u32>, id: Id) -> Option<u32> {
    module.number(id).or_else(|| known.get(&id).or_else(|| local.get(&id)).copied())
}

/// The values that a block computes. Within the block, an instruction sees only values from earlier blocks.
fn values(
    module: &Module,
    block: &Block,
    lookup: &dyn Fn(Id) -> Option<u32>,
    returned: &HashMap<Id, u32>,
) -> Vec<(Id, u32)> {
    let value = |i: &Instruction| {
        let words = &module[*i];
        let value = match i.op {
            Op::FunctionCall => returned.get(&words[3]).copied(),
            Op::Phi => {
                let mut values = words[3..].iter().step_by(2).map(|id| lookup(*id));
                let first = values.next().flatten();
                first.filter(|_| values.all(|value| value == first))
            }
            op => evaluate(op, words.get(3..)?, lookup),
        };
        value.map(|value| (words[2], value))
    };
    block.body.iter().filter_map(value).collect()
}

/// Drops the blocks that nothing reaches. Adds to `removed` what they define.
pub fn drop_unreached(module: &mut Module, function: &mut Function, removed: &mut HashSet<Id>) {
    let at = places(&function.blocks);
    let mut reached = HashSet::new();
    let mut open: Vec<Id> = function.blocks.first().map(|b| b.label).into_iter().collect();
    while let Some(label) = open.pop() {
        if reached.insert(label)
            && let Some(place) = at.get(&label)
        {
            open.extend(function.blocks[*place].targets(module));
        }
    }
    // Structured control flow requires the merge and continue blocks even if they are unreachable; they become
    // empty.
    let (mut merges, mut continues) = (HashSet::new(), HashMap::new());
    for header in function.blocks.iter().filter(|b| reached.contains(&b.label)) {
        let (merge, next) = header.structure(module);
        merges.extend(merge);
        continues.extend(next.map(|next| (next, header.label)));
    }
    let mut sources: HashMap<Id, HashSet<Id>> = HashMap::new();
    for (index, block) in function.blocks.iter_mut().enumerate() {
        if index > 0 && !reached.contains(&block.label) {
            removed.extend(block.body.iter().filter_map(|i| module.result(*i)));
            block.body = match continues.get(&block.label) {
                Some(header) => vec![module.make(Op::Branch, &[*header])],
                None => vec![module.make(Op::Unreachable, &[])],
            };
            if !merges.contains(&block.label) && !continues.contains_key(&block.label) {
                removed.insert(block.label);
                continue;
            }
        }
        for target in block.targets(module) {
            sources.entry(target).or_default().insert(block.label);
        }
    }
    function.blocks.retain(|b| !removed.contains(&b.label));
    // A phi must have one value per predecessor.
    for block in &mut function.blocks {
        let from = sources.get(&block.label);
        for phi in block.body.iter_mut().filter(|i| i.op == Op::Phi) {
            let words = &module[*phi];
            let is_source = |pair: &&[u32]| pair.len() == 2 && from.is_some_and(|from| from.contains(&pair[1]));
            let pairs: Vec<u32> = words[3..].chunks(2).filter(is_source).flatten().copied().collect();
            let operands = [&words[1..3], &pairs].concat();
            if operands.len() + 1 != words.len() {
                *phi = module.make(Op::Phi, &operands);
            }
        }
    }
}
