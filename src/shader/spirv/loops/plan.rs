//! Decides which loops count their rounds, and the weight of each round.

use std::cell::RefCell;

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::rounds::{Loop, MOST};
use crate::shader::spirv::module::{Id, Module};
use crate::shader::spirv::op::Op;

/// A counted loop inside a bounded one counts its own rounds too, if it takes more than this many.
const MOST_INSIDE: u64 = 64;
/// The largest number of rounds that one round of a loop counts for.
const MOST_WEIGHT: u64 = 1024;

/// Decides which loops count their rounds.
pub(super) struct Plan<'a> {
    module: &'a Module,
    loops: &'a [Vec<Loop>],
    /// The functions that each loop calls, those of the loops inside it excepted.
    calls: Vec<Vec<Vec<usize>>>,
    /// The functions that each function calls outside of loops.
    calls_outside: Vec<Vec<usize>>,
    /// The rounds of each function's loops, once they are known.
    of_calls: RefCell<HashMap<usize, u64>>,
}

impl<'a> Plan<'a> {
    pub(super) fn new(module: &'a Module, loops: &'a [Vec<Loop>]) -> Self {
        let places: HashMap<Id, usize> = module.functions.iter().enumerate().map(|(at, f)| (f.id, at)).collect();
        let mut calls = Vec::new();
        let mut calls_outside = Vec::new();
        for (function, loops) in module.functions.iter().zip(loops) {
            let (mut own, mut outside) = (vec![Vec::new(); loops.len()], Vec::new());
            for (index, block) in function.blocks.iter().enumerate() {
                let around = (0..loops.len()).filter(|at| loops[*at].members.contains(&index));
                let innermost = around.min_by_key(|at| loops[*at].members.len());
                let called = block.body.iter().filter(|i| i.op == Op::FunctionCall);
                let called = called.filter_map(|i| places.get(&module[*i][3]).copied());
                innermost.map_or(&mut outside, |at| &mut own[at]).extend(called);
            }
            calls.push(own);
            calls_outside.push(outside);
        }
        Self { module, loops, calls, calls_outside, of_calls: RefCell::default() }
    }

    /// The loops that count, for each function, with the rounds that one round of theirs counts for: itself and the
    /// counted loops in it.
    pub(super) fn bounded(&self) -> Vec<Vec<(usize, u32)>> {
        let mut inside: HashSet<usize> = HashSet::new();
        loop {
            let bounded: Vec<HashSet<usize>> =
                (0..self.loops.len()).map(|function| self.of_function(function, inside.contains(&function))).collect();
            let mut called: HashSet<usize> = inside.clone();
            for (function, own) in bounded.iter().enumerate() {
                let is_within = |at: &usize| own.iter().any(|around| self.contains(function, *around, *at));
                let within = (0..self.loops[function].len()).filter(is_within);
                called.extend(within.flat_map(|at| &self.calls[function][at]));
                if inside.contains(&function) {
                    called.extend(self.calls[function].iter().flatten().chain(&self.calls_outside[function]));
                }
            }
            if called.len() == inside.len() {
                return self.weigh(&bounded);
            }
            inside = called;
        }
    }

    /// Whether a loop is `around` or inside of it.
    fn contains(&self, function: usize, around: usize, at: usize) -> bool {
        self.loops[function][around].members.contains(&self.loops[function][at].header)
    }

    /// The loops of a function that count, where the function is called `inside` another loop that counts or not.
    fn of_function(&self, function: usize, inside: bool) -> HashSet<usize> {
        let loops = &self.loops[function];
        // The outer ones first.
        let mut order: Vec<usize> = (0..loops.len()).filter(|at| self.can_count(function, *at)).collect();
        order.sort_by_key(|at| std::cmp::Reverse(loops[*at].members.len()));
        let mut bounded = HashSet::new();
        for at in order {
            let within = inside || bounded.iter().any(|around| self.contains(function, *around, at));
            let most = if within { MOST_INSIDE } else { MOST };
            if loops[at].rounds.is_none() || self.rounds(function, at) > most {
                bounded.insert(at);
            }
        }
        bounded
    }

    /// Whether the loop's header has the form that glslang gives it.
    fn can_count(&self, function: usize, at: usize) -> bool {
        let blocks = &self.module.functions[function].blocks;
        blocks[self.loops[function][at].header].ends_with(Op::Branch)
    }

    /// The rounds of a loop with those of the counted loops inside it, however deep.
    fn rounds(&self, function: usize, at: usize) -> u64 {
        let own = &self.loops[function];
        let inner = (0..own.len()).filter(|inner| own[*inner].parent == Some(at));
        let inner: u64 = inner.map(|inner| self.rounds(function, inner)).fold(0, u64::saturating_add);
        let called = self.calls[function][at].iter().map(|called| self.of_call(*called));
        let each = called.fold(inner.saturating_add(1), u64::saturating_add);
        own[at].rounds.unwrap_or(1).saturating_mul(each)
    }

    /// The rounds of the loops of a called function.
    fn of_call(&self, function: usize) -> u64 {
        // GLSL has no recursion, but a module that has it must not end this program: 0 stands until the sum is known.
        let known = self.of_calls.borrow_mut().insert(function, 0);
        if let Some(known) = known {
            self.of_calls.borrow_mut().insert(function, known);
            return known;
        }
        let outermost = (0..self.loops[function].len()).filter(|at| self.loops[function][*at].parent.is_none());
        let loops = outermost.map(|at| self.rounds(function, at));
        let called = self.calls_outside[function].iter().map(|called| self.of_call(*called));
        let sum = loops.chain(called).fold(0, u64::saturating_add);
        self.of_calls.borrow_mut().insert(function, sum);
        sum
    }

    /// The weight of each loop that counts.
    fn weigh(&self, bounded: &[HashSet<usize>]) -> Vec<Vec<(usize, u32)>> {
        let mut known = HashMap::new();
        let mut out = Vec::new();
        for (function, own) in bounded.iter().enumerate() {
            let mut weights = Vec::new();
            for at in own.iter().copied() {
                let plain = self.plain(function, bounded).filter(|i| self.loops[function][*i].parent == Some(at));
                let inner = plain.map(|i| self.rounds(function, i)).fold(1, u64::saturating_add);
                let calls = self.calls[function][at].iter();
                let called = calls.map(|called| self.uncounted(*called, bounded, &mut known));
                // A large weight would end a loop after few rounds.
                weights.push((at, called.fold(inner, u64::saturating_add).min(MOST_WEIGHT) as u32));
            }
            weights.sort_unstable();
            out.push(weights);
        }
        out
    }

    /// The loops of a function that do not count.
    fn plain<'b>(&'b self, function: usize, bounded: &'b [HashSet<usize>]) -> impl Iterator<Item = usize> + 'b {
        (0..self.loops[function].len()).filter(move |at| !bounded[function].contains(at))
    }

    /// The rounds of the loops of a called function that do not count themselves.
    fn uncounted(&self, function: usize, bounded: &[HashSet<usize>], known: &mut HashMap<usize, u64>) -> u64 {
        if let Some(sum) = known.get(&function) {
            return *sum;
        }
        known.insert(function, 0);
        let outermost = self.plain(function, bounded).filter(|at| self.loops[function][*at].parent.is_none());
        let mut sum = outermost.map(|at| self.rounds(function, at)).fold(0, u64::saturating_add);
        for called in &self.calls_outside[function] {
            sum = sum.saturating_add(self.uncounted(*called, bounded, known));
        }
        known.insert(function, sum);
        sum
    }
}
