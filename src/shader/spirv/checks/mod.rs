//! Instruments a module so that it finds operations whose result GLSL leaves open, and assertions that fail: see [`Rule`].
//!
//! A call and a branch for each operation would take a driver minutes to compile. So the first module only sets a bit of an array of its
//! own for each operation that broke its rule, without a branch, and its entry point adds the bits to a buffer at its end. For the few
//! operations that did, a second module calls a function with their operands.

mod derivatives;
mod operands;
mod operations;
mod quads;
mod rule;
mod sets;
mod statements;
mod suspect;
mod track;
mod unset;

use std::collections::BTreeSet;

use super::module::{Function, Id, Instruction, Module};
use super::op::Op;
use super::reach::file_of;
use super::trace::NumberKind;
use quads::Quads;
pub use rule::Rule;
use suspect::{Selected, Suspect, selected};
use track::{Tracked, TrackedFunction};

/// Words of the array of bits.
pub const MASK_WORDS: usize = 128;
/// Derivatives that are checked; others are not.
pub const MOST_DERIVATIVES: usize = 128;
/// Operands that a check gives, as bits.
pub const MOST_OPERANDS: usize = 4;

/// Names of what the module gets from its own text.
pub struct Names<'a> {
    /// The array of [`MASK_WORDS`] numbers.
    pub mask: &'a str,
    /// `void function(const in uint check, const in uvec4 bits)`: gets the number of a check from 1, or 0 if its rule is kept, and operands.
    pub function: &'a str,
    /// The same for a `print()`.
    pub print: &'a str,
    /// `uint function()`: the invocations of the quad that have begun and do not run along, as bits; the text may lack it.
    pub gone: &'a str,
    /// An array of [`MOST_DERIVATIVES`] numbers: of a derivative, the invocations that did not run along, and the number of its check.
    pub quads: &'a str,
    /// Functions whose names begin with this are not checked.
    pub silent: &'a str,
}

/// An operation that is checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// The file, as the compiler knows it.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// The rule.
    pub rule: Rule,
    /// The variable that is read; empty for other rules.
    pub name: String,
    /// The number of the text that an `assert()` or a `print()` has in its file.
    pub text: Option<u32>,
    /// The types of the operands that it gives, and how many numbers each has: at most [`MOST_OPERANDS`] in all.
    pub operands: Vec<(NumberKind, u32)>,
}

/// An instrumented module.
#[derive(Debug)]
pub struct Checked {
    /// The module.
    pub words: Vec<u32>,
    /// Its checks. Both modules of a stage have the same ones.
    pub checks: Vec<Check>,
    /// How many there are beyond the bits of the array.
    pub left_out: usize,
}

/// Instruments a module with line information: its `assert()` and `print()`, and, with `undefined`, all operations. With `chosen`, these
/// checks call the function; without, all set bits. Checks beyond the bits of the array are left out. `None` if the module lacks a name.
pub fn check(words: &[u32], names: &Names<'_>, undefined: bool, chosen: Option<&BTreeSet<usize>>) -> Option<Checked> {
    let mut module = Module::parse(words)?;
    let to = match chosen {
        Some(chosen) => {
            let [function, print] = [names.function, names.print].map(|name| module.named(&format!("{name}(")).next());
            Report::Operands { function: function?, print: print?, chosen }
        }
        None => Report::Bits { mask: module.named(names.mask).next()? },
    };
    let extended = module.head.iter().find(|i| i.op == Op::ExtInstImport).map(|i| module[*i][1]);
    let silent: BTreeSet<Id> = module.named(names.silent).collect();
    let quads = Quads::of(&mut module, [names.gone, names.quads]);
    let order = module.entry_function().and_then(|entry| module.callees_first(entry)).unwrap_or_default();
    let mut functions = std::mem::take(&mut module.functions);
    let mut tracked =
        if undefined { Tracked::of(&mut module, &functions, &order, &silent) } else { Tracked::default() };
    let mut checker = Checker::new(&mut module, &functions, (to, extended), undefined);
    checker.quads = quads;
    for function in &mut functions {
        let is_silent = silent.contains(&function.id);
        function.head.retain(|i| !is_line(*i));
        checker.selected = selected(checker.module, function);
        checker.tracked = tracked.take(checker.module, function.id);
        for (at, block) in function.blocks.iter_mut().enumerate() {
            match is_silent {
                true => block.body.retain(|i| !is_line(*i)),
                false => block.body = checker.block(at, &block.body),
            }
        }
        std::mem::take(&mut checker.tracked).declare(checker.module, function);
    }
    let Checker { checks, left_out, .. } = checker;
    module.functions = functions;
    // The passes that follow expect no lines.
    module.globals.retain(|i| !is_line(*i));
    module.debug.retain(|i| matches!(i.op, Op::Name | Op::MemberName));
    Some(Checked { words: module.write(), checks, left_out })
}

/// An author's own function of the name may return something.
fn returns_nothing(module: &Module, function: &Function) -> bool {
    module.defined(Op::TypeVoid, function.returns(module)).is_some()
}

fn is_line(i: Instruction) -> bool {
    matches!(i.op, Op::Line | Op::NoLine)
}

/// The effect of a check that fails.
enum Report<'a> {
    /// Sets a bit of the array.
    Bits { mask: Id },
    /// Calls the function, if it is one of these.
    Operands { function: Id, print: Id, chosen: &'a BTreeSet<usize> },
}

struct Checker<'a> {
    module: &'a mut Module,
    to: Report<'a>,
    /// The extended instructions of GLSL.
    extended: Option<Id>,
    undefined: bool,
    /// The functions `assert` and `print`.
    asserts: Vec<Id>,
    prints: Vec<Id>,
    void: Id,
    uint: Id,
    uvec4: Id,
    /// Results that only a select reads, which computes both sides: see [`selected`].
    selected: Selected,
    /// Suspects that wait for the select that reads their result.
    waiting: Vec<(Id, Suspect, usize)>,
    checks: Vec<Check>,
    left_out: usize,
    /// The variables of the function that may be read before they are set.
    tracked: TrackedFunction,
    quads: Quads,
}

impl<'a> Checker<'a> {
    fn new(
        module: &'a mut Module,
        functions: &[Function],
        (to, extended): (Report<'a>, Option<Id>),
        undefined: bool,
    ) -> Self {
        let returns_nothing = |id: &Id| functions.iter().any(|of| of.id == *id && returns_nothing(module, of));
        let named = |name| module.named(name).filter(returns_nothing).collect();
        let [asserts, prints] = ["assert(b1;", "print(i1;"].map(named);
        let void = module.declare(Op::TypeVoid, &[]);
        let uint = module.declare(Op::TypeInt, &[32, 0]);
        let uvec4 = module.declare(Op::TypeVector, &[uint, 4]);
        let (selected, waiting, checks, left_out) = (Selected::default(), Vec::new(), Vec::new(), 0);
        Self {
            module,
            to,
            extended,
            undefined,
            asserts,
            prints,
            void,
            uint,
            uvec4,
            selected,
            waiting,
            checks,
            left_out,
            tracked: TrackedFunction::default(),
            quads: Quads::default(),
        }
    }

    /// The instructions of a block, the one at a place of its function, with checks between them, without lines.
    fn block(&mut self, at: usize, body: &[Instruction]) -> Vec<Instruction> {
        let (mut out, mut line): (Vec<Instruction>, _) = (Vec::with_capacity(body.len()), None);
        for (place, &i) in body.iter().enumerate() {
            if is_line(i) {
                line = (i.op == Op::Line).then_some(i);
                continue;
            }
            if i.op == Op::Select {
                self.report_selected(&mut out, i);
            }
            if let Some((file, line)) = line.and_then(|line| file_of(self.module, &self.module[line])) {
                let own = self.own_statement(&mut out, i);
                let others = if self.undefined { self.suspects(&mut out, i) } else { Vec::new() };
                let unset = self.unset(&mut out, (at, place));
                for suspect in own.into_iter().chain(others).chain(unset) {
                    self.add(&mut out, i, suspect, (file.clone(), line));
                }
                if self.undefined {
                    self.derivative(&mut out, i, (file, line));
                }
            }
            out.push(i);
            self.note_sets(&mut out, (at, place));
        }
        out
    }

    /// Adds a check of an instruction, and reports now or where its result is selected.
    fn add(&mut self, out: &mut Vec<Instruction>, i: Instruction, suspect: Suspect, (file, line): (String, u32)) {
        if self.checks.len() == 32 * MASK_WORDS {
            self.left_out += 1;
            return;
        }
        let shown = self.shown(&suspect);
        let operands = shown.into_iter().map(|(operand, count)| (self.kind(operand), count)).collect();
        self.checks.push(Check {
            file,
            line,
            rule: suspect.rule,
            name: suspect.name.clone(),
            text: suspect.text,
            operands,
        });
        let number = self.checks.len() - 1;
        match self.module.result(i).filter(|result| self.selected.contains(result)) {
            Some(result) => self.waiting.push((result, suspect, number)),
            None => self.report(out, &suspect, number),
        }
    }

    /// Adds a check without operands. Returns whether there was room.
    fn push_check(&mut self, (file, line): (String, u32), rule: Rule) -> bool {
        let has_room = self.checks.len() < 32 * MASK_WORDS;
        if has_room {
            self.checks.push(Check { file, line, rule, name: String::new(), text: None, operands: Vec::new() });
        }
        has_room
    }

    /// Reports what a select is about to read, if it reads that side.
    fn report_selected(&mut self, out: &mut Vec<Instruction>, select: Instruction) {
        let (condition, sides) = (self.module[select][3], [self.module[select][4], self.module[select][5]]);
        let read = |(result, ..): &mut (Id, Suspect, usize)| sides.contains(result);
        let read: Vec<_> = self.waiting.extract_if(.., read).collect();
        for (result, suspect, number) in read {
            let suspect = self.if_selected(out, suspect, condition, result == sides[0]);
            self.report(out, &suspect, number);
        }
    }

    fn report(&mut self, out: &mut Vec<Instruction>, suspect: &Suspect, number: usize) {
        match self.to {
            Report::Bits { mask } => {
                let broken = self.any(out, suspect.broken);
                self.set_bit(out, mask, broken, number);
            }
            Report::Operands { function, print, chosen } if chosen.contains(&number) => {
                let function = if suspect.rule == Rule::Print { print } else { function };
                self.call(out, function, suspect, number as u32);
            }
            Report::Operands { .. } => {}
        }
    }

    /// Sets the bit of a check in the array where a condition is true.
    fn set_bit(&mut self, out: &mut Vec<Instruction>, mask: Id, broken: Id, number: usize) {
        let m = &mut *self.module;
        let [word, bit, zero] = [number as u32 / 32, 1 << (number % 32), 0].map(|bits| m.constant(self.uint, bits));
        let class = m.pointer(m.type_of(mask)).map_or(0, |(class, _)| class);
        let pointer = m.declare(Op::TypePointer, &[class, self.uint]);
        let bit = m.emit(out, Op::Select, self.uint, &[broken, bit, zero]);
        let place = m.emit(out, Op::AccessChain, pointer, &[mask, word]);
        let before = m.emit(out, Op::Load, self.uint, &[place]);
        let now = m.emit(out, Op::BitwiseOr, self.uint, &[before, bit]);
        out.push(self.module.make(Op::Store, &[place, now]));
    }
}
