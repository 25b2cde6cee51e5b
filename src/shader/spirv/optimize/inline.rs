//! Puts the bodies of functions in place of their calls.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};
use std::rc::Rc;

use super::MOST_INSTRUCTIONS;
use super::graph::Graph;
use super::module::{Module, typed_result};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::is_id;
use crate::shader::spirv::specialize::control_flow::{Block, Function};
use crate::shader::spirv::specialize::{Id, Instruction, instruction, opcode};

/// How a function returns, which decides how it can be inlined.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Returns {
    /// Once, outside all constructs.
    AtEnd,
    /// From within selections. Inlined, it becomes the one case of a switch, which it leaves by a break (SPIR-V
    /// specification, section 2.11: a branch may leave selections for the merge block of the innermost switch).
    Early,
    /// Never, or from within a loop or a switch: calls stay.
    Never,
}

struct Callee {
    function: Function,
    returns: Returns,
}

/// Inlines all calls that can be inlined, callees first, and drops functions that nothing calls anymore. `None` if functions
/// call themselves, or the module would grow too much.
pub(super) fn inline_calls(module: &mut Module) -> Option<()> {
    let mut waiting: HashMap<Id, Function> =
        module.functions.drain(..).map(|function| (function.id, function)).collect();
    let calls = |function: &Function| function.calls().collect::<Vec<_>>();
    // Callees before callers.
    let (mut order, mut open, mut seen) = (Vec::new(), vec![(module.entry, false)], HashSet::new());
    while let Some((id, is_done)) = open.pop() {
        if is_done {
            order.push(id);
        } else if seen.insert(id) {
            open.push((id, true));
            open.extend(calls(waiting.get(&id)?).into_iter().map(|callee| (callee, false)));
        }
    }
    let mut inliner = Inliner { module, callees: HashMap::new(), ids: Vec::new(), made: 0 };
    for id in order {
        let function = inliner.inline_into(waiting.remove(&id)?)?;
        let returns = returns(&function);
        inliner.callees.insert(id, Rc::new(Callee { function, returns }));
    }
    let mut callees = inliner.callees;
    let (mut kept, mut open) = (HashSet::from_iter([module.entry]), vec![module.entry]);
    while let Some(id) = open.pop() {
        let function = Rc::into_inner(callees.remove(&id)?)?.function;
        open.extend(function.calls().filter(|id| kept.insert(*id)));
        module.functions.push(function);
    }
    Some(())
}

fn returns(function: &Function) -> Returns {
    let graph = Graph::new(&function.blocks);
    let is_return =
        |block: &Block| block.body.last().is_some_and(|i| matches!(opcode(i), op::RETURN | op::RETURN_VALUE));
    let ends: Vec<usize> = graph.order.iter().copied().filter(|block| is_return(&function.blocks[*block])).collect();
    let mut is_early = ends.len() > 1;
    for (header, block) in function.blocks.iter().enumerate() {
        let (Some(merge), next) = block.structure() else { continue };
        if !ends.iter().any(|end| graph.is_within(header, merge, *end)) {
            continue;
        }
        let is_switch = block.body.last().is_some_and(|i| opcode(i) == op::SWITCH);
        if next.is_some() || is_switch {
            return Returns::Never;
        }
        is_early = true;
    }
    match (ends.is_empty(), is_early) {
        (true, _) => Returns::Never,
        (_, true) => Returns::Early,
        _ => Returns::AtEnd,
    }
}

struct Inliner<'a> {
    module: &'a mut Module,
    /// Functions in which calls have been inlined.
    callees: HashMap<Id, Rc<Callee>>,
    /// The ids of the current callee in its caller; 0 for those of the module. Those of other callees may be left.
    ids: Vec<Id>,
    /// Instructions made so far.
    made: usize,
}

/// The blocks of a function as they are rewritten.
struct Caller {
    blocks: Vec<Block>,
    /// The block that is being filled.
    current: Block,
    /// Variables of inlined functions.
    variables: Vec<Instruction>,
}

impl Caller {
    /// Ends the current block, and begins another.
    fn next(&mut self, label: Id) {
        let block = std::mem::replace(&mut self.current, Block { label, body: Vec::new() });
        self.blocks.push(block);
    }
}

impl Inliner<'_> {
    fn inline_into(&mut self, function: Function) -> Option<Function> {
        if function.calls().next().is_none() {
            return Some(function);
        }
        let graph = Graph::new(&function.blocks);
        let continues: Vec<(usize, Id)> = {
            let loops = function.blocks.iter().filter_map(|block| match block.structure() {
                (Some(merge), Some(next)) => Some((*graph.at.get(&next)?, merge)),
                _ => None,
            });
            loops.collect()
        };
        let Function { id, head, blocks } = function;
        let first = blocks.first()?.label;
        let current = Block { label: first, body: Vec::new() };
        let mut caller = Caller { blocks: Vec::new(), current, variables: Vec::new() };
        // Labels of blocks that were split, and of their last parts, which the caller's own phis follow.
        let mut split: HashMap<Id, Id> = HashMap::new();
        let own = |block: &Block| block.body.iter().filter(|i| opcode(i) == op::PHI).map(|i| i[2]).collect::<Vec<_>>();
        let own_phis: HashSet<Id> = blocks.iter().flat_map(own).collect();
        for (place, block) in blocks.into_iter().enumerate() {
            if place > 0 {
                caller.next(block.label);
            }
            // A loop's header must hold its merge instruction, and a continue construct must stay a simple chain.
            let is_whole = block.structure().1.is_some()
                || continues.iter().any(|(next, merge)| *next == place || graph.is_within(*next, *merge, place));
            for i in block.body {
                match self.callees.get(i.get(3).unwrap_or(&0)) {
                    Some(callee) if opcode(&i) == op::FUNCTION_CALL && callee.can_be_in(is_whole) => {
                        self.inline(&i, &mut caller)?;
                    }
                    _ => caller.current.body.push(i),
                }
            }
            if caller.current.label != block.label {
                split.insert(block.label, caller.current.label);
            }
        }
        let Caller { mut blocks, current, variables } = caller;
        blocks.push(current);
        for i in blocks.iter_mut().flat_map(|block| &mut block.body) {
            self.module.resolve_operands(i);
            if opcode(i) == op::PHI && own_phis.contains(&i[2]) {
                for from in i[3..].iter_mut().skip(1).step_by(2) {
                    *from = split.get(from).copied().unwrap_or(*from);
                }
            }
        }
        blocks.first_mut()?.body.splice(0..0, variables);
        Some(Function { id, head, blocks })
    }

    /// Puts the function that `call` calls at the end of the current block.
    fn inline(&mut self, call: &[u32], caller: &mut Caller) -> Option<()> {
        let callee = self.callees.get(&call[3])?.clone();
        let Callee { function, returns } = &*callee;
        let results = function.blocks.iter().flat_map(|block| &block.body);
        self.made += results.clone().count();
        if self.made > MOST_INSTRUCTIONS {
            return None;
        }
        self.ids.resize(self.module.next_id() as usize, 0);
        for (parameter, argument) in function.head.iter().skip(1).zip(&call[4..]) {
            self.ids[parameter[2] as usize] = *argument;
        }
        for block in &function.blocks {
            self.ids[block.label as usize] = self.module.fresh(0);
            for (_, id) in block.body.iter().filter_map(|i| typed_result(i)) {
                self.ids[id as usize] = self.module.copy_of(id);
            }
        }
        let is_simple = function.blocks.len() == 1;
        let end = self.module.fresh(0);
        if *returns == Returns::Early {
            let selector = self.module.any_integer()?;
            let first = self.ids[function.blocks.first()?.label as usize];
            caller.current.body.push(instruction(op::SELECTION_MERGE, &[end, 0]));
            caller.current.body.push(instruction(op::SWITCH, &[selector, first]));
            caller.next(first);
        } else {
            self.ids[function.blocks.first()?.label as usize] = caller.current.label;
        }
        let mut values = Vec::new();
        for (place, block) in function.blocks.iter().enumerate() {
            if place > 0 {
                caller.next(self.ids[block.label as usize]);
            }
            for i in &block.body {
                let i = self.moved(i);
                match opcode(&i) {
                    op::VARIABLE => {
                        // Its initial value is stored whenever the function is called.
                        caller.variables.push(instruction(op::VARIABLE, &i[1..4]));
                        caller.current.body.extend(i.get(4).map(|value| instruction(op::STORE, &[i[2], *value])));
                    }
                    op::RETURN | op::RETURN_VALUE => {
                        values.extend(i.get(1).map(|value| [*value, caller.current.label]));
                        if !is_simple {
                            caller.current.body.push(instruction(op::BRANCH, &[end]));
                        }
                    }
                    _ => caller.current.body.push(i),
                }
            }
        }
        if !is_simple {
            caller.next(end);
        }
        match *values {
            [] => {}
            [[value, _]] => self.module.replace(call[2], value),
            _ => caller.current.body.push(instruction(op::PHI, &[&call[1..3], values.as_flattened()].concat())),
        }
        Some(())
    }

    /// An instruction of the current callee with the ids of the caller.
    fn moved(&mut self, i: &[u32]) -> Instruction {
        let mut moved = i.to_vec();
        for at in 1..i.len() {
            if is_id(i, at) == Some(true) {
                let id = self.ids[i[at] as usize];
                moved[at] = if id == 0 { i[at] } else { id };
            }
        }
        moved
    }
}

impl Callee {
    /// Whether the function can be inlined, as a single block if the caller says so.
    fn can_be_in(&self, is_whole: bool) -> bool {
        match self.returns {
            Returns::AtEnd => !is_whole || self.function.blocks.len() == 1,
            Returns::Early => !is_whole,
            Returns::Never => false,
        }
    }
}
