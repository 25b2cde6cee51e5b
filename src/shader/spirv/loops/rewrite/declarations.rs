//! The variables, constants and the buffer that counting loops need, and the entry point's interface that lists them.

use crate::shader::spirv::enums::{built_in, decoration, model, storage};
use crate::shader::spirv::loops::bounds::Bounds;
use crate::shader::spirv::module::{Id, Instruction, Module, Type};
use crate::shader::spirv::op::Op;

/// The ids that every bounded loop uses.
#[derive(Clone, Copy)]
pub(super) struct Shared {
    pub(super) uint: Id,
    pub(super) boolean: Id,
    /// Counter of rounds, and name of the loop that used them up: private variables.
    pub(super) counter: Id,
    pub(super) culprit: Id,
    pub(super) zero: Id,
    pub(super) budget: Id,
    pub(super) half: Id,
    /// One more than the budget: the counter's value once it has been used up.
    pub(super) over: Id,
}

/// The ids of the buffer that names the loop.
#[derive(Clone, Copy)]
pub(super) struct Buffer {
    pub(super) variable: Id,
    /// Type of a pointer to one of its words.
    pub(super) pointer: Id,
    pub(super) one: Id,
    pub(super) two: Id,
}

impl Shared {
    pub(super) fn declare(module: &mut Module, bounds: &Bounds) -> Self {
        let uint = module.declare(Op::TypeInt, &[32, 0]);
        let boolean = module.declare(Op::TypeBool, &[]);
        let pointer = module.declare(Op::TypePointer, &[storage::PRIVATE, uint]);
        Self {
            uint,
            boolean,
            counter: module.variable(pointer, storage::PRIVATE),
            culprit: module.variable(pointer, storage::PRIVATE),
            zero: module.constant(uint, 0),
            budget: module.constant(uint, bounds.rounds),
            half: module.constant(uint, bounds.rounds / 2),
            over: module.constant(uint, bounds.rounds + 1),
        }
    }
}

impl Buffer {
    /// Declares the buffer that names the loop: `buffer { uint words[3]; }`.
    pub(super) fn declare(module: &mut Module, shared: &Shared, (set, binding): (u32, u32)) -> Self {
        let [one, two, three] = [1, 2, 3].map(|number| module.constant(shared.uint, number));
        let array = module.declare_another(Op::TypeArray, &[shared.uint, three]);
        let block = module.declare_another(Op::TypeStruct, &[array]);
        let to_block = module.declare(Op::TypePointer, &[storage::STORAGE_BUFFER, block]);
        let variable = module.variable(to_block, storage::STORAGE_BUFFER);
        let pointer = module.declare(Op::TypePointer, &[storage::STORAGE_BUFFER, shared.uint]);
        module.decorate(&[array, decoration::ARRAY_STRIDE, 4]);
        module.decorate(&[block, decoration::BLOCK]);
        let offset = module.make(Op::MemberDecorate, &[block, 0, decoration::OFFSET, 0]);
        module.decorations.push(offset);
        module.decorate(&[variable, decoration::DESCRIPTOR_SET, set]);
        module.decorate(&[variable, decoration::BINDING, binding]);
        Self { variable, pointer, one, two }
    }
}

/// The output variable at location 0, if it is a `vec4`, and a constant of that type.
pub(super) fn mark(module: &mut Module, entry: Instruction, color: [f32; 4]) -> Option<(Id, Id)> {
    let vec4 = |id: Id| {
        let (class, vector) = module.pointer(*module.defined(Op::Variable, id)?.get(1)?)?;
        let Type::Vector { of, count: 4 } = module.get_type(vector)? else { return None };
        let is_float = matches!(module.get_type(of), Some(Type::Float { .. }));
        let is_output = class == storage::OUTPUT && module.decoration(id, decoration::LOCATION) == Some(0);
        (is_float && is_output).then_some((id, vector, of))
    };
    let (output, vector, component) = module[entry][3..].iter().copied().find_map(vec4)?;
    let parts = color.map(|x| module.constant(component, x.to_bits()));
    let color = module.declare(Op::ConstantComposite, &[&[vector], &parts[..]].concat());
    Some((output, color))
}

/// Lists the new variables in the entry point's interface. A fragment stage that writes a buffer would run its
/// depth test late; without `discard` and own depth, the early test makes no difference but the time.
pub(super) fn join_interface(module: &mut Module, shared: &Shared, report: Option<Buffer>) {
    const EARLY_FRAGMENT_TESTS: u32 = 9;
    const DEPTH_REPLACING: u32 = 12;
    let report = report.map(|report| report.variable);
    let variables: Vec<Id> = [shared.counter, shared.culprit].into_iter().chain(report).collect();
    module.join_interface(&variables);
    let ends = module.functions.iter().flat_map(|function| &function.blocks).filter_map(|block| block.end());
    let discards = ends.into_iter().any(|i| matches!(i.op, Op::Kill | Op::TerminateInvocation));
    let mut modes = module.head.iter().filter(|i| i.op == Op::ExecutionMode).map(|i| module[*i][2]);
    let changes_test = modes.any(|mode| matches!(mode, EARLY_FRAGMENT_TESTS | DEPTH_REPLACING))
        || module
            .decorated(decoration::BUILT_IN)
            .any(|id| module.decoration(id, decoration::BUILT_IN) == Some(built_in::SAMPLE_MASK));
    if let Some(main) = module.entry_function()
        && module.model() == Some(model::FRAGMENT)
        && report.is_some()
        && !discards
        && !changes_test
    {
        let mode = module.make(Op::ExecutionMode, &[main, EARLY_FRAGMENT_TESTS]);
        let modes = module.head.iter().position(|i| i.op == Op::ExecutionMode).unwrap_or(module.head.len());
        module.head.insert(modes, mode);
    }
}
