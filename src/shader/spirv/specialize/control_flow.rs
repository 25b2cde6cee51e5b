//! The blocks of a function: takes branches on known values and drops unreachable blocks.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::{Id, Instruction, Known, evaluate, instruction, op, opcode};

/// A basic block: its label and its instructions, including the branch at its end.
pub(in crate::shader::spirv) struct Block {
    pub(in crate::shader::spirv) label: Id,
    pub(in crate::shader::spirv) body: Vec<Instruction>,
}

impl Block {
    /// The merge and continue blocks that the block's merge instruction names.
    pub(in crate::shader::spirv) fn structure(&self) -> (Option<Id>, Option<Id>) {
        let merge = self.body.iter().rev().nth(1);
        match merge.map(|i| (opcode(i), i)) {
            Some((op::SELECTION_MERGE, i)) => (i.get(1).copied(), None),
            Some((op::LOOP_MERGE, i)) => (i.get(1).copied(), i.get(2).copied()),
            _ => (None, None),
        }
    }

    pub(in crate::shader::spirv) fn targets(&self) -> Vec<Id> {
        let Some(last) = self.body.last() else { return Vec::new() };
        match opcode(last) {
            op::BRANCH => last[1..].to_vec(),
            op::BRANCH_CONDITIONAL => last.get(2..4).unwrap_or_default().to_vec(),
            op::SWITCH => last.iter().skip(2).enumerate().filter(|(at, _)| at % 2 == 0).map(|(_, id)| *id).collect(),
            _ => Vec::new(),
        }
    }
}

/// A function: the instructions before its first block, and its blocks.
pub(in crate::shader::spirv) struct Function {
    pub(in crate::shader::spirv) id: Id,
    pub(in crate::shader::spirv) head: Vec<Instruction>,
    pub(in crate::shader::spirv) blocks: Vec<Block>,
}

impl Function {
    pub(in crate::shader::spirv) fn parse(instructions: &[&[u32]]) -> Option<Self> {
        let id = *instructions.first()?.get(2)?;
        let mut function = Self { id, head: Vec::new(), blocks: Vec::new() };
        for i in instructions.iter().filter(|i| opcode(i) != op::FUNCTION_END) {
            match (opcode(i), function.blocks.last_mut()) {
                (op::LABEL, _) => function.blocks.push(Block { label: *i.get(1)?, body: Vec::new() }),
                (_, Some(block)) => block.body.push(i.to_vec()),
                (_, None) => function.head.push(i.to_vec()),
            }
        }
        Some(function)
    }

    /// The value that the function always returns, if its body is nothing but a return.
    pub(super) fn constant(&self, known: &Known) -> Option<u32> {
        match (self.blocks.as_slice(), self.blocks.first()?.body.as_slice()) {
            ([_], [only]) if opcode(only) == op::RETURN_VALUE => known.values.get(only.get(1)?).copied(),
            _ => None,
        }
    }

    /// Takes decided branches and drops unreachable blocks until nothing changes: dropping a block can decide another
    /// branch.
    pub(in crate::shader::spirv) fn fold(&mut self, known: &Known, removed: &mut HashSet<Id>) {
        let mut any = false;
        while self.take_branches(known) {
            self.drop_unreached(removed);
            any = true;
        }
        if any {
            self.sort();
        }
    }

    /// Reorders blocks so that each follows its dominators (SPIR-V specification, section 2.4). Taking a branch can
    /// change the dominators where a switch case falls through. Unreachable blocks come last.
    fn sort(&mut self) {
        let at: HashMap<Id, usize> = self.blocks.iter().enumerate().map(|(index, b)| (b.label, index)).collect();
        let ways = |index: usize| self.blocks[index].targets().into_iter().filter_map(|id| at.get(&id).copied());
        let (mut seen, mut finished) = (vec![false; self.blocks.len()], Vec::new());
        let mut open: Vec<(usize, bool)> = vec![(0, false)];
        while let Some((index, is_done)) = open.pop() {
            if is_done {
                finished.push(index);
            } else if !std::mem::replace(&mut seen[index], true) {
                open.push((index, true));
                open.extend(ways(index).filter(|to| !seen[*to]).map(|to| (to, false)));
            }
        }
        let rest = (0..self.blocks.len()).filter(|index| !seen[*index]);
        let order: Vec<usize> = finished.into_iter().rev().chain(rest).collect();
        let mut blocks: Vec<Option<Block>> = self.blocks.drain(..).map(Some).collect();
        self.blocks = order.into_iter().filter_map(|index| blocks[index].take()).collect();
    }

    /// Takes all branches that known values decide; returns whether there was one.
    fn take_branches(&mut self, known: &Known) -> bool {
        let mut local: HashMap<Id, u32> = HashMap::new();
        let mut any = false;
        // Keep the conditional branch that exits a loop, even if it is decided: a loop construct needs both a back edge
        // and an exit.
        let loops = self.blocks.iter().map(Block::structure).filter(|(_, next)| next.is_some());
        let loop_ends: HashSet<Id> = loops.filter_map(|(merge, _)| merge).collect();
        for block in &mut self.blocks {
            let lookup = |id: Id| known.values.get(&id).or_else(|| local.get(&id)).copied();
            let mut found = Vec::new();
            for i in block.body.iter().filter(|i| i.len() > 3) {
                let value = match opcode(i) {
                    op::FUNCTION_CALL => known.returned.get(&i[3]).copied(),
                    op::PHI => {
                        let mut values = i[3..].iter().step_by(2).map(|id| lookup(*id));
                        let first = values.next().flatten();
                        first.filter(|_| values.all(|value| value == first))
                    }
                    // Within the same block, an instruction sees only values from earlier blocks.
                    operation => evaluate(operation, &i[3..], &lookup),
                };
                found.extend(value.map(|value| (i[2], value)));
            }
            local.extend(found);
            any |= take_case(block, &|id| known.values.get(&id).or_else(|| local.get(&id)).copied());
            let Some(last) = block.body.last().filter(|i| opcode(i) == op::BRANCH_CONDITIONAL) else { continue };
            let condition = last.get(1).and_then(|id| known.values.get(id).or_else(|| local.get(id)));
            let (Some(condition), Some([yes, no])) = (condition, last.get(2..4)) else { continue };
            if loop_ends.contains(yes) || loop_ends.contains(no) {
                continue;
            }
            let taken = if *condition != 0 { *yes } else { *no };
            block.body.pop();
            block.body.pop_if(|i| opcode(i) == op::SELECTION_MERGE);
            block.body.push(instruction(op::BRANCH, &[taken]));
            any = true;
        }
        any
    }

    pub(in crate::shader::spirv) fn drop_unreached(&mut self, removed: &mut HashSet<Id>) {
        let at: HashMap<Id, usize> = self.blocks.iter().enumerate().map(|(index, b)| (b.label, index)).collect();
        let block = |id: &Id| at.get(id).map(|index| &self.blocks[*index]);
        let mut reached = HashSet::new();
        let mut open: Vec<Id> = self.blocks.first().map(|b| b.label).into_iter().collect();
        while let Some(label) = open.pop() {
            if reached.insert(label) {
                open.extend(block(&label).into_iter().flat_map(Block::targets));
            }
        }
        // Structured control flow requires the merge and continue blocks even if they are unreachable; they become
        // empty.
        let (mut merges, mut continues) = (HashSet::new(), HashMap::new());
        for header in self.blocks.iter().filter(|b| reached.contains(&b.label)) {
            let (merge, next) = header.structure();
            merges.extend(merge);
            continues.extend(next.map(|next| (next, header.label)));
        }
        let mut sources: HashMap<Id, HashSet<Id>> = HashMap::new();
        for (index, block) in self.blocks.iter_mut().enumerate() {
            if index > 0 && !reached.contains(&block.label) {
                results(&block.body, removed);
                block.body = match continues.get(&block.label) {
                    Some(header) => vec![instruction(op::BRANCH, &[*header])],
                    None => vec![instruction(op::UNREACHABLE, &[])],
                };
                if !merges.contains(&block.label) && !continues.contains_key(&block.label) {
                    removed.insert(block.label);
                    continue;
                }
            }
            for target in block.targets() {
                sources.entry(target).or_default().insert(block.label);
            }
        }
        self.blocks.retain(|b| !removed.contains(&b.label));
        // A phi must have one value per predecessor.
        for block in &mut self.blocks {
            let from = sources.get(&block.label);
            for phi in block.body.iter_mut().filter(|i| opcode(i) == op::PHI) {
                let is_source = |pair: &&[u32]| pair.len() == 2 && from.is_some_and(|from| from.contains(&pair[1]));
                let pairs: Vec<u32> = phi[3..].chunks(2).filter(is_source).flatten().copied().collect();
                let operands = [&phi[1..3], &pairs].concat();
                *phi = instruction(op::PHI, &operands);
            }
        }
    }

    pub(in crate::shader::spirv) fn calls(&self) -> impl Iterator<Item = Id> {
        let all = self.blocks.iter().flat_map(|b| &b.body);
        all.filter(|i| opcode(i) == op::FUNCTION_CALL).filter_map(|i| i.get(3).copied())
    }

    /// Adds every id that the function defines.
    pub(in crate::shader::spirv) fn results(&self, out: &mut HashSet<Id>) {
        results(&self.head, out);
        for block in &self.blocks {
            out.insert(block.label);
            results(&block.body, out);
        }
    }

    pub(in crate::shader::spirv) fn write(&self, out: &mut Vec<u32>) {
        out.extend(self.head.iter().flatten());
        for block in &self.blocks {
            out.extend(instruction(op::LABEL, &[block.label]));
            out.extend(block.body.iter().flatten());
        }
        out.extend(instruction(op::FUNCTION_END, &[]));
    }
}

/// Reduces a switch on a known value to its default target, the case that is taken. The switch itself remains, since
/// breaks inside need it.
fn take_case(block: &mut Block, lookup: &dyn Fn(Id) -> Option<u32>) -> bool {
    let Some(last) = block.body.last_mut().filter(|i| opcode(i) == op::SWITCH && i.len() > 3) else { return false };
    let Some(value) = lookup(last[1]) else { return false };
    let case = last[3..].chunks_exact(2).find(|case| case[0] == value).map(|case| case[1]);
    *last = instruction(op::SWITCH, &[last[1], case.unwrap_or(last[2])]);
    true
}

/// Adds the ids that these instructions define.
fn results(instructions: &[Instruction], out: &mut HashSet<Id>) {
    let with_result = instructions.iter().filter(|i| !op::WITHOUT_RESULT.contains(&opcode(i)));
    out.extend(with_result.filter_map(|i| i.get(2)));
}
