//! Puts the bodies of functions in place of their calls.

use foldhash::{HashMap, HashMapExt, HashSet};
use std::rc::Rc;

use super::graph::Graph;
use super::optimizer::Optimizer;
use crate::shader::spirv::enums::storage;
use crate::shader::spirv::module::{Block, Function, Id, Instruction, Module};
use crate::shader::spirv::op::Op;

/// The instructions that inlining may make of a module: more would take longer than they save.
const MOST_INSTRUCTIONS: usize = 150_000;

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
pub(super) fn inline_calls(optimizer: &mut Optimizer) -> Option<()> {
    let entry = optimizer.module.entry_function()?;
    let order = optimizer.module.callees_first(entry)?;
    let mut waiting: Vec<Option<Function>> = optimizer.module.functions.drain(..).map(Some).collect();
    let mut inliner = Inliner { optimizer, callees: HashMap::new(), ids: Vec::new(), made: 0 };
    for place in order {
        let function = inliner.inline_into(waiting[place].take()?)?;
        let returns = returns(&inliner.optimizer.module, &function);
        inliner.callees.insert(function.id, Rc::new(Callee { function, returns }));
    }
    let mut callees = inliner.callees;
    let (mut kept, mut open) = (HashSet::from_iter([entry]), vec![entry]);
    while let Some(id) = open.pop() {
        let function = Rc::into_inner(callees.remove(&id)?)?.function;
        open.extend(function.calls(&optimizer.module).filter(|id| kept.insert(*id)));
        optimizer.module.functions.push(function);
    }
    Some(())
}

fn returns(module: &Module, function: &Function) -> Returns {
    let graph = Graph::new(module, &function.blocks);
    let is_return = |block: &Block| block.ends_with(Op::Return) || block.ends_with(Op::ReturnValue);
    let ends: Vec<usize> = graph.order.iter().copied().filter(|block| is_return(&function.blocks[*block])).collect();
    let mut is_early = ends.len() > 1;
    for (header, block) in function.blocks.iter().enumerate() {
        let (Some(merge), next) = block.structure(module) else { continue };
        if !ends.iter().any(|end| graph.is_within(header, merge, *end)) {
            continue;
        }
        if next.is_some() || block.ends_with(Op::Switch) {
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
    optimizer: &'a mut Optimizer,
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
        let module = &self.optimizer.module;
        if function.calls(module).next().is_none() {
            return Some(function);
        }
        let graph = Graph::new(module, &function.blocks);
        let loops = function.blocks.iter().filter_map(|block| match block.structure(module) {
            (Some(merge), Some(next)) => Some((*graph.at.get(&next)?, merge)),
            _ => None,
        });
        let continues: Vec<(usize, Id)> = loops.collect();
        // A loop's header must hold its merge instruction, and a continue construct must stay a simple chain.
        let is_whole = |place: usize, block: &Block| {
            block.structure(module).1.is_some()
                || continues.iter().any(|(next, merge)| *next == place || graph.is_within(*next, *merge, place))
        };
        let is_whole: Vec<bool> = function.blocks.iter().enumerate().map(|(at, block)| is_whole(at, block)).collect();
        let own_phis: HashSet<Id> = function.body().filter(|i| i.op == Op::Phi).map(|i| module[i][2]).collect();
        let Function { id, head, blocks } = function;
        let first = blocks.first()?.label;
        let current = Block { label: first, body: Vec::new() };
        let mut caller = Caller { blocks: Vec::new(), current, variables: Vec::new() };
        // Labels of blocks that were split, and of their last parts, which the caller's own phis follow.
        let mut split: HashMap<Id, Id> = HashMap::new();
        for ((place, block), is_whole) in blocks.into_iter().enumerate().zip(is_whole) {
            if place > 0 {
                caller.next(block.label);
            }
            for i in block.body {
                let called =
                    (i.op == Op::FunctionCall).then(|| self.callees.get(&self.optimizer.module[i][3])).flatten();
                match called.filter(|callee| callee.can_be_in(is_whole)).cloned() {
                    Some(callee) => self.inline(&callee, i, &mut caller)?,
                    None => caller.current.body.push(i),
                }
            }
            if caller.current.label != block.label {
                split.insert(block.label, caller.current.label);
            }
        }
        let Caller { mut blocks, current, variables } = caller;
        blocks.push(current);
        for &i in blocks.iter().flat_map(|block| &block.body) {
            self.optimizer.resolve_operands(i);
            let words = &mut self.optimizer.module[i];
            if i.op == Op::Phi && own_phis.contains(&words[2]) {
                for from in words[3..].iter_mut().skip(1).step_by(2) {
                    *from = split.get(from).copied().unwrap_or(*from);
                }
            }
        }
        blocks.first_mut()?.body.splice(0..0, variables);
        Some(Function { id, head, blocks })
    }

    /// Puts the function that `call` calls at the end of the current block.
    fn inline(&mut self, Callee { function, returns }: &Callee, call: Instruction, caller: &mut Caller) -> Option<()> {
        self.made += function.body().count();
        if self.made > MOST_INSTRUCTIONS {
            return None;
        }
        self.ids.resize(self.optimizer.module.bound() as usize, 0);
        let module = &self.optimizer.module;
        for (parameter, argument) in function.head.iter().skip(1).zip(&module[call][4..]) {
            self.ids[module[*parameter][2] as usize] = *argument;
        }
        for block in &function.blocks {
            self.ids[block.label as usize] = self.optimizer.module.fresh(0);
            for i in &block.body {
                if let Some(id) = self.optimizer.module.result(*i) {
                    self.ids[id as usize] = self.optimizer.copy_of(id);
                }
            }
        }
        let is_simple = function.blocks.len() == 1;
        let end = self.optimizer.module.fresh(0);
        let entry = function.blocks.first()?.label as usize;
        if *returns == Returns::Early {
            let selector = self.optimizer.any_integer()?;
            let (module, first) = (&mut self.optimizer.module, self.ids[entry]);
            caller.current.body.push(module.make(Op::SelectionMerge, &[end, 0]));
            caller.current.body.push(module.make(Op::Switch, &[selector, first]));
            caller.next(first);
        } else {
            self.ids[entry] = caller.current.label;
        }
        let mut values = Vec::new();
        for (place, block) in function.blocks.iter().enumerate() {
            if place > 0 {
                caller.next(self.ids[block.label as usize]);
            }
            for &i in &block.body {
                let module = &mut self.optimizer.module;
                // The instruction with the ids of the caller. Ids of the module stay.
                let i = module.copy(i, |id| match self.ids[id as usize] {
                    0 => id,
                    new => new,
                });
                match (i.op, &module[i]) {
                    (Op::Variable, &[_, kind, id, _, ref initial @ ..]) => {
                        // Its initial value is stored whenever the function is called.
                        let initial = initial.first().copied();
                        caller.variables.push(module.make(Op::Variable, &[kind, id, storage::FUNCTION]));
                        caller.current.body.extend(initial.map(|value| module.make(Op::Store, &[id, value])));
                    }
                    (Op::Return | Op::ReturnValue, words) => {
                        values.extend(words.get(1).map(|value| [*value, caller.current.label]));
                        if !is_simple {
                            caller.current.body.push(module.make(Op::Branch, &[end]));
                        }
                    }
                    _ => caller.current.body.push(i),
                }
            }
        }
        if !is_simple {
            caller.next(end);
        }
        let result = self.optimizer.module[call][2];
        match *values {
            [] => {}
            [[value, _]] => self.optimizer.replace(result, value),
            _ => {
                let operands = [&self.optimizer.module[call][1..3], values.as_flattened()].concat();
                caller.current.body.push(self.optimizer.module.make(Op::Phi, &operands));
            }
        }
        Some(())
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
