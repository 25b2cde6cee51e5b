//! Logs what statements do: numbers and conditions of all types where they are stored, returned or decided about, copies and constants too,
//! the arguments of functions, discards, and where functions begin and end, so that each value has the call that it belongs to.

use super::branches::{Branches, ConstantBranch};
use super::functions::{Functions, is_line};
use super::{MOST_PARTS, NumberKind, Place, Purpose, Tracer};
use crate::shader::spirv::module::{Function, Id, Instruction, Type};
use crate::shader::spirv::op::Op;
use crate::shader::spirv::reach::file_of;

/// glslang's name for the copy of an argument.
const ARGUMENT: &str = "param";
/// Bits of a loop's control.
const UNROLL: u32 = 1;
const DONT_UNROLL: u32 = 2;
const ALL: [NumberKind; 4] = [NumberKind::Float, NumberKind::Int, NumberKind::Uint, NumberKind::Bool];

fn is_merge(i: Instruction) -> bool {
    matches!(i.op, Op::SelectionMerge | Op::LoopMerge)
}

impl Tracer<'_> {
    /// The instructions of a block with calls between them, without lines. `caller`: the number of the call that made the function's.
    /// `is_last`: the block ends the function.
    pub(super) fn statements(
        &mut self,
        body: &[Instruction],
        branches: &Branches,
        (caller, is_last): (Id, bool),
    ) -> Vec<Instruction> {
        let (mut out, mut line): (Vec<Instruction>, _) = (Vec::with_capacity(body.len()), None);
        for (at, &i) in body.iter().enumerate() {
            if is_line(i) {
                line = (i.op == Op::Line).then_some(i);
                continue;
            }
            // A merge instruction stands directly before its branch, which therefore logs before both.
            if is_merge(i) {
                let branch = body[at + 1..].iter().copied().find(|i| !is_line(*i));
                let branch = branch.filter(|_| !branches.is_of_expression(self.module, i));
                if let Some(branch) = branch {
                    let constant = branches.constant(self.module, branch, Some(i));
                    self.statement(&mut out, branch, line, constant);
                }
                if i.op == Op::LoopMerge {
                    // Copies of a body would each have to be compiled.
                    self.module[i][3] = self.module[i][3] & !UNROLL | DONT_UNROLL;
                }
            } else if !(out.last().is_some_and(|i| is_merge(*i)) || is_last && i.op == Op::Return) {
                let constant = branches.constant(self.module, i, None);
                self.statement(&mut out, i, line, constant);
            }
            if matches!(i.op, Op::ReturnValue | Op::Return) {
                self.module.emit(&mut out, Op::FunctionCall, self.void, &[self.calls.leave, caller]);
            }
            out.push(i);
        }
        out
    }

    /// Appends what an instruction does. `constant`: the instruction is a branch by a constant.
    fn statement(
        &mut self,
        out: &mut Vec<Instruction>,
        i: Instruction,
        line: Option<Instruction>,
        constant: Option<ConstantBranch>,
    ) {
        let (purpose, value) = match (i.op, &self.module[i][1..]) {
            (Op::Store, [pointer, value, ..]) => {
                let (name, path, indices) = self.stored_at(*pointer);
                if name == ARGUMENT || name.is_empty() {
                    return;
                }
                self.indices = indices;
                (Purpose::Store(name + &path), Some(*value))
            }
            (Op::ReturnValue, [value]) => (Purpose::Return, Some(*value)),
            (Op::BranchConditional | Op::Switch, [condition, ..]) => (Purpose::Condition, Some(*condition)),
            (Op::Kill | Op::TerminateInvocation | Op::DemoteToHelperInvocation, _) => (Purpose::Discard, None),
            (Op::Return, _) => (Purpose::Leave, None),
            _ => return,
        };
        let line = constant.as_ref().map_or(line, |constant| constant.line);
        let between = constant.and_then(|constant| constant.between);
        let purpose = between.map_or(purpose, |between| Purpose::Constant { between });
        let file = line.and_then(|line| file_of(self.module, &self.module[line]));
        if let Some((file, line)) = file.filter(|(file, _)| self.is_wanted(file)) {
            self.log_at(out, Place { file, line, purpose }, value);
        }
        self.indices.clear();
    }

    /// Whether the statements of a file are logged.
    fn is_wanted(&self, file: &str) -> bool {
        self.only.is_none_or(|only| only.contains(file))
    }

    /// Whether values of a type are logged: they have numbers, and not too many.
    fn is_short(&self, kind: Id) -> bool {
        (1..=MOST_PARTS).contains(&self.parts_of(kind, &ALL))
    }

    /// Instructions for the start of a function, which log that it begins, and its arguments. Structs are left out: they were logged where
    /// they were made. Also the number of the call that made it.
    pub(super) fn enter(&mut self, function: &Function, known: &Functions) -> (Vec<Instruction>, Id) {
        let name = self.names.get(&function.id).map(|name| name.split('(').next().unwrap_or_default().to_owned());
        let first = known.first.get(&function.id).and_then(|line| file_of(self.module, &self.module[*line]));
        let (file, line) = first.unwrap_or_default();
        let mut out = Vec::new();
        let place = |purpose| Place { file: file.clone(), line, purpose };
        let light = self.light_parameters.of(function.id);
        let number = light.map(|(parameter, _)| self.loaded(&mut out, parameter));
        self.places.push(place(Purpose::Enter(name.unwrap_or_default(), light.map(|(_, list)| list))));
        let caller = self.log_call(&mut out, number);
        let parameters = function.head.iter().filter(|i| i.op == Op::FunctionParameter).map(|i| self.module[*i][2]);
        let parameters: Vec<(usize, Id)> = parameters.enumerate().collect();
        for (at, parameter) in parameters {
            if line == 0 || !self.is_wanted(&file) || !known.given.contains(&(function.id, at)) {
                continue;
            }
            let name = self.names.get(&parameter).cloned().unwrap_or_default();
            let kind = self.module.type_of(parameter);
            let to = self.module.pointer(kind).map(|(_, to)| to);
            let of = to.unwrap_or(kind);
            if name.is_empty() || !self.is_short(of) || matches!(self.module.get_type(of), Some(Type::Struct { .. })) {
                continue;
            }
            let value = self.loaded(&mut out, parameter);
            self.log_at(&mut out, place(Purpose::Argument(name)), Some(value));
        }
        (out, caller)
    }

    /// Appends the call that logs the start of a function, at the last place. Returns the number of the call that made it. `light`: the number
    /// of the light that it is about.
    fn log_call(&mut self, out: &mut Vec<Instruction>, light: Option<Id>) -> Id {
        let kind = light.map_or(NumberKind::Bool, |light| match self.module.get_type(self.module.type_of(light)) {
            Some(Type::Int { signed: true, .. }) => NumberKind::Int,
            _ => NumberKind::Uint,
        });
        let bits = match (light, kind) {
            (None, _) => self.zero,
            (Some(light), NumberKind::Int) => self.module.emit(out, Op::Bitcast, self.uint, &[light]),
            (Some(light), _) => light,
        };
        let point = self.new_point(kind, (u32::from(light.is_some()), 0), String::new());
        self.module.emit(out, Op::FunctionCall, self.uint, &[self.calls.enter, point, bits])
    }

    /// The value of a parameter, which glslang passes by a pointer unless it is constant.
    fn loaded(&mut self, out: &mut Vec<Instruction>, parameter: Id) -> Id {
        let to = self.module.pointer(self.module.type_of(parameter)).map(|(_, to)| to);
        to.map_or(parameter, |to| self.module.emit(out, Op::Load, to, &[parameter]))
    }

    /// Appends calls for a place, which has a value, or none. A value that is too long is left out.
    fn log_at(&mut self, out: &mut Vec<Instruction>, place: Place, value: Option<Id>) {
        if value.is_some_and(|value| !self.is_short(self.module.type_of(value))) {
            return;
        }
        self.places.push(place);
        match value {
            Some(value) => self.log_parts(out, value, &ALL, String::new()),
            None => self.log(out, None, (NumberKind::Bool, 0), String::new()),
        }
    }
}
