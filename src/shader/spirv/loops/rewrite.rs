//! Counting loops: their headers count, and the ends of the entry point report.

mod declarations;

use declarations::{Buffer, Shared};

use super::bounds::Bounds;
use super::place::{name, seed};
use super::plan::Plan;
use super::rounds::{self, Loop};
use crate::shader::spirv::module::{Block, Function, Id, Instruction, Module};
use crate::shader::spirv::op::Op;

/// Bounds the loops of a specialization of the module `original`. Returns whether the module has a loop that needs it; otherwise the
/// module stays as it is.
pub fn bound(module: &mut Module, original: &[u32], bounds: &Bounds) -> bool {
    // Most specialized modules have no loop at all.
    let has_loops = module.code().any(|i| i.op == Op::LoopMerge);
    has_loops && rewritten(module, original, bounds).is_some()
}

/// `None`, and no change, if there is no loop that needs it.
fn rewritten(module: &mut Module, original: &[u32], bounds: &Bounds) -> Option<()> {
    let loops: Vec<Vec<Loop>> = module.functions.iter().map(|function| rounds::find(module, function)).collect();
    let bounded = Plan::new(module, &loops).bounded();
    if bounded.iter().all(Vec::is_empty) {
        return None;
    }
    let entry = module.entry()?;
    let main = module.functions.iter().position(|function| function.id == module[entry][2])?;
    let seed = seed(original);
    let shared = Shared::declare(module, bounds);
    let report = bounds.report.map(|place| Buffer::declare(module, &shared, place));
    let mark = bounds.mark.and_then(|color| declarations::mark(module, entry, color));
    let named = module.constant(shared.uint, name(seed, 0));
    let mut functions = std::mem::take(&mut module.functions);
    let mut rewriter = Rewriter { module, shared, report, mark, named, seed };
    for ((function, bounded), loops) in functions.iter_mut().zip(&bounded).zip(&loops) {
        for (index, weight) in bounded {
            rewriter.count(function, &loops[*index], *weight);
        }
        if !bounded.is_empty() {
            rewriter.return_instead(function);
        }
    }
    for (place, function) in functions.iter_mut().enumerate() {
        rewriter.end(function, place == main);
    }
    rewriter.begin(&mut functions[main], bounds);
    module.functions = functions;
    declarations::join_interface(module, &shared, report);
    Some(())
}

struct Rewriter<'a> {
    module: &'a mut Module,
    shared: Shared,
    report: Option<Buffer>,
    /// The output variable that a mark is stored to, and the mark.
    mark: Option<(Id, Id)>,
    /// The name of the module.
    named: Id,
    seed: u64,
}

impl Rewriter<'_> {
    /// Makes the header of a loop count rounds and leave the loop once the budget is used up. The merge block stores
    /// the loop's name if the loop took half of the budget.
    fn count(&mut self, function: &mut Function, of: &Loop, weight: u32) {
        let m = &mut *self.module;
        let Shared { uint, boolean, counter, zero, budget, half, over, .. } = self.shared;
        let (header, merge) = (function.blocks[of.header].label, function.blocks[of.merge].label);
        let weight = m.constant(uint, weight);
        let own_name = m.constant(uint, name(self.seed, header));

        // The loop has taken the rounds that were counted since it was entered.
        let start = match of.before {
            Some(before) => {
                let mut load = Vec::new();
                let start = m.emit(&mut load, Op::Load, uint, &[counter]);
                let body = &mut function.blocks[before].body;
                let merges = body.iter().rev().nth(1).is_some_and(|i| i.op == Op::SelectionMerge);
                let end = body.len() - 1 - usize::from(merges);
                body.splice(end..end, load);
                start
            }
            None => zero,
        };

        let body = &mut function.blocks[of.header].body;
        let next = body.pop().map_or(header, |branch| m[branch][1]);
        let merge_instruction = body.pop();
        let old = m.emit(body, Op::Load, uint, &[counter]);
        let new = m.emit(body, Op::IAdd, uint, &[old, weight]);
        body.push(m.make(Op::Store, &[counter, new]));
        let is_over = m.emit(body, Op::UGreaterThan, boolean, &[new, budget]);
        body.extend(merge_instruction);
        body.push(m.make(Op::BranchConditional, &[is_over, merge, next]));

        // The merge block has the header as another predecessor.
        let body = &mut function.blocks[of.merge].body;
        let phis = body.iter().take_while(|i| i.op == Op::Phi).count();
        for phi in &mut body[..phis] {
            let kind = m[*phi][1];
            let undefined = m.declare(Op::Undef, &[kind]);
            let operands = [&m[*phi][1..], &[undefined, header]].concat();
            *phi = m.make(Op::Phi, &operands);
        }
        let mut code = Vec::new();
        let rounds = m.emit(&mut code, Op::Load, uint, &[counter]);
        let is_past = m.emit(&mut code, Op::UGreaterThan, boolean, &[rounds, budget]);
        let spent = m.emit(&mut code, Op::ISub, uint, &[rounds, start]);
        let is_most = m.emit(&mut code, Op::UGreaterThanEqual, boolean, &[spent, half]);
        let culprit = m.emit(&mut code, Op::Load, uint, &[self.shared.culprit]);
        let is_first = m.emit(&mut code, Op::IEqual, boolean, &[culprit, zero]);
        let both = m.emit(&mut code, Op::LogicalAnd, boolean, &[is_past, is_most]);
        let is_it = m.emit(&mut code, Op::LogicalAnd, boolean, &[both, is_first]);
        let named = m.emit(&mut code, Op::Select, uint, &[is_it, own_name, culprit]);
        code.push(m.make(Op::Store, &[self.shared.culprit, named]));
        // The counter must not wrap around, however often a counted loop enters this one.
        let clamped = m.emit(&mut code, Op::Select, uint, &[is_past, over, rounds]);
        code.push(m.make(Op::Store, &[counter, clamped]));
        body.splice(phis..phis, code);
    }

    /// Returns zero where a function ends with `OpUnreachable`: a loop that could only be left by a return is now left
    /// by its budget too.
    fn return_instead(&mut self, function: &mut Function) {
        let returned = function.returns(self.module);
        for block in function.blocks.iter_mut().filter(|block| block.ends_with(Op::Unreachable)) {
            block.body.pop();
            block.body.push(self.module.return_zero(returned));
        }
    }

    /// Where an invocation ends, writes the name of the loop that used up the budget, and marks the fragment.
    fn end(&mut self, function: &mut Function, is_main: bool) {
        let Shared { uint, boolean, counter, budget, .. } = self.shared;
        let mut blocks = Vec::with_capacity(function.blocks.len());
        for mut block in function.blocks.drain(..) {
            let mark = self.mark.filter(|_| block.ends_with(Op::Return));
            let is_end = match block.end().map(|i| i.op) {
                Some(Op::Return) => is_main && (self.report.is_some() || mark.is_some()),
                Some(Op::Kill | Op::TerminateInvocation | Op::EmitMeshTasksEXT) => self.report.is_some(),
                _ => false,
            };
            if !is_end {
                blocks.push(block);
                continue;
            }
            let last: Vec<Instruction> = block.body.pop().into_iter().collect();
            let mut code = self.report.map(|report| self.name_culprit(report)).unwrap_or_default();
            let m = &mut *self.module;
            let [inside, after] = m.ids();
            let rounds = m.emit(&mut block.body, Op::Load, uint, &[counter]);
            let is_over = m.emit(&mut block.body, Op::UGreaterThan, boolean, &[rounds, budget]);
            block.body.push(m.make(Op::SelectionMerge, &[after, 0]));
            block.body.push(m.make(Op::BranchConditional, &[is_over, inside, after]));
            code.extend(mark.map(|(to, color)| m.make(Op::Store, &[to, color])));
            code.push(m.make(Op::Branch, &[after]));
            blocks.extend([block, Block { label: inside, body: code }, Block { label: after, body: last }]);
        }
        function.blocks = blocks;
    }

    /// Writes the culprit's name, or the module's, unless another invocation has named a loop before.
    fn name_culprit(&mut self, report: Buffer) -> Vec<Instruction> {
        let m = &mut *self.module;
        let Shared { uint, boolean, zero, .. } = self.shared;
        let Buffer { variable, pointer, one, two } = report;
        let mut code = Vec::new();
        let culprit = m.emit(&mut code, Op::Load, uint, &[self.shared.culprit]);
        let is_one = m.emit(&mut code, Op::INotEqual, boolean, &[culprit, zero]);
        let word = m.emit(&mut code, Op::Select, uint, &[is_one, zero, one]);
        let value = m.emit(&mut code, Op::Select, uint, &[is_one, culprit, self.named]);
        let place = m.emit(&mut code, Op::AccessChain, pointer, &[variable, zero, word]);
        // Scope: device. No order with other memory.
        m.emit(&mut code, Op::AtomicCompareExchange, uint, &[place, one, zero, zero, value, zero]);
        let flag = m.emit(&mut code, Op::AccessChain, pointer, &[variable, zero, two]);
        code.push(m.make(Op::Store, &[flag, zero]));
        code
    }

    /// Sets the counter where the invocation begins.
    fn begin(&mut self, main: &mut Function, bounds: &Bounds) {
        let m = &mut *self.module;
        let Shared { uint, boolean, counter, culprit, zero, .. } = self.shared;
        let (mut first, mut code) = (zero, Vec::new());
        if let Some(Buffer { variable, pointer, two, .. }) = self.report {
            let late = m.constant(uint, bounds.rounds.saturating_sub(bounds.rounds_after));
            let place = m.emit(&mut code, Op::AccessChain, pointer, &[variable, zero, two]);
            let flag = m.emit(&mut code, Op::Load, uint, &[place]);
            let is_late = m.emit(&mut code, Op::IEqual, boolean, &[flag, zero]);
            first = m.emit(&mut code, Op::Select, uint, &[is_late, late, zero]);
        }
        code.push(m.make(Op::Store, &[counter, first]));
        code.push(m.make(Op::Store, &[culprit, zero]));
        if let Some(block) = main.blocks.first_mut() {
            let variables = block.body.iter().take_while(|i| i.op == Op::Variable).count();
            block.body.splice(variables..variables, code);
        }
    }
}
