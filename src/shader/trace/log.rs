//! The log that a traced stage writes: what each of the chosen invocations does.
//!
//! An invocation has a part of the log. It begins with a header and a counter for each log point. The calls of functions follow: the first
//! `MOST_CALLS` and the last. Then come the events of each log point: the first and the last of them, in as many slots as there is room for,
//! so a long loop takes no room from the statements behind it. An event has its number among all events of the invocation, by which they are
//! sorted, and the number of its call.
//!
//! The part is chosen by one atomic addition for each invocation, since fragments of a pixel may run at the same time. Everything else is
//! written without atomics.

use std::collections::HashMap;

use super::Invocations;
use super::stage::{Listener, TracedStage};
use crate::shader::StageKind;
use crate::shader::spirv::trace::{Logged, with_constants};

/// Most invocations that are logged: fragments of a pixel, or vertices of a triangle with the times that each is drawn.
pub const MOST_FRAGMENTS: u32 = 16;
/// More than the largest number of a log point.
pub const MOST_POINTS: u32 = 1 << 13;
/// Events of a log point that are kept at least: so many of the first, and as many of the last.
pub const LEAST_KEPT: u32 = 16;
/// Calls of functions that are kept: so many of the first, and as many of the last.
const MOST_CALLS: u32 = 1 << 12;
/// Words before the first invocation: how many there are, and [`Invocations::words`].
const START: u32 = 4;
/// Words of an invocation before its counters: its number, whether it came to its end, its result, how many calls it has made, its samples, and
/// its primitive.
const HEADER: u32 = 9;
/// Words of a call: the number of its caller, the number of its log point, and the number of its light.
const CALL: u32 = 3;
/// Words of an event: its number, that of its call, and the bits of up to four numbers.
const EVENT: u32 = 6;
/// Words of an invocation, unless its log points need more for [`LEAST_KEPT`].
const PART: u32 = 1 << 18;
/// Words of a log.
const WORDS: u32 = START + MOST_FRAGMENTS * PART;
/// Bytes of a log.
pub const SIZE: u64 = 4 * WORDS as u64;
/// Words of the text that stand for what is known once the module is instrumented: the address of the log, and numbers of its [`Layout`].
const LATER: [&str; 9] = [
    "SPECULA_LOW",
    "SPECULA_HIGH",
    "SPECULA_KEPT",
    "SPECULA_MASK",
    "SPECULA_STRIDE",
    "SPECULA_PART",
    "SPECULA_FRAGMENTS",
    "SPECULA_FIRST_CALL",
    "SPECULA_FIRST_EVENT",
];
/// The number in the module for the first of these. Those for the others follow.
const FIRST_LATER: u32 = 0xC0DE_0A01;
/// The function that logs an event.
pub(super) const FUNCTION: &str = "specula_trace";
/// Extensions for a text that writes to a buffer by its address.
pub const EXTENSIONS: &str = "#extension GL_EXT_buffer_reference : require\n#extension GL_EXT_buffer_reference_uvec2 : require\n\
    #extension GL_EXT_scalar_block_layout : require";

/// The text that writes the log of a stage of this kind, and of its `color` if it has one. `None` for kinds that are not traced.
/// `has_primitives`: whether it gets the numbers of the model's primitives; `places_quads`: whether it places the corners of quads.
pub(super) fn listener(
    kind: StageKind,
    color: Option<&str>,
    has_primitives: bool,
    places_quads: bool,
) -> Option<Listener> {
    // Which invocation is logged, its number, and its result.
    let [is_logged, own_number, result] = match kind {
        StageKind::Fragment => [
            "!gl_HelperInvocation && uvec2(gl_FragCoord.xy) == logged.xy",
            "floatBitsToUint(gl_FragCoord.z)",
            color.unwrap_or("vec4(0.0)"),
        ],
        StageKind::Vertex if places_quads => {
            ["uint(gl_InstanceIndex) == logged.x", "uint(gl_VertexIndex)", "gl_Position"]
        }
        StageKind::Vertex => ["any(equal(uvec3(gl_VertexIndex), logged))", "uint(gl_VertexIndex)", "gl_Position"],
        StageKind::Compute => ["gl_GlobalInvocationID == logged", "0u", "vec4(0.0)"],
        _ => return None,
    };
    // The mask alone does not make a device run the stage for each sample, as the number of a sample would.
    let samples = if kind == StageKind::Fragment { "uint(gl_SampleMaskIn[0])" } else { "0u" };
    let primitive = if has_primitives { "uint(gl_PrimitiveID) + 1u" } else { "0u" };
    let mut text = include_str!("log.glsl")
        .replace("SPECULA_CALLS", &format!("{MOST_CALLS}u"))
        .replace("SPECULA_HEADER", &format!("{HEADER}u"))
        .replace("SPECULA_IS_LOGGED", is_logged)
        .replace("SPECULA_NUMBER", own_number)
        .replace("SPECULA_SAMPLES", samples)
        .replace("SPECULA_PRIMITIVE", primitive)
        .replace("SPECULA_RESULT", result);
    for (number, word) in (FIRST_LATER..).zip(LATER) {
        text = text.replace(word, &format!("{number}u"));
    }
    Some(Listener { text, extensions: EXTENSIONS, function: FUNCTION, logged: Logged::Statements })
}

/// The places of a log, for a stage with a number of log points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// One more than the largest number of a log point.
    points: u32,
    /// Events of a log point that are kept: so many of the first, and as many of the last. A power of two.
    kept: u32,
}

impl Layout {
    /// The layout for log points with the numbers from 1 to `points`, which is less than [`MOST_POINTS`].
    pub(super) fn new(points: usize) -> Self {
        let points = u32::try_from(points + 1).map_or(MOST_POINTS, |points| points.min(MOST_POINTS));
        let none = Self { points, kept: 0 };
        let room = (PART - none.first_event()) / (2 * EVENT * points);
        Self { points, kept: if room > LEAST_KEPT { 1 << room.ilog2() } else { LEAST_KEPT } }
    }

    fn first_call(self) -> u32 {
        HEADER + self.points
    }

    fn first_event(self) -> u32 {
        self.first_call() + 2 * MOST_CALLS * CALL
    }

    /// Words for the events of a log point.
    fn stride(self) -> u32 {
        2 * self.kept * EVENT
    }

    /// Words of an invocation.
    fn part(self) -> u32 {
        self.first_event() + self.points * self.stride()
    }

    /// Most invocations that are logged.
    fn fragments(self) -> u32 {
        ((WORDS - START) / self.part()).min(MOST_FRAGMENTS)
    }

    /// The words that must be 0 before the stage runs: the first ones of all invocations, in bytes.
    pub fn cleared(self) -> impl Iterator<Item = (u64, usize)> {
        let length = 4 * self.first_call() as usize;
        (0..self.fragments()).map(move |fragment| (4 * u64::from(START + fragment * self.part()), length))
    }

    /// Bytes of a log that has this many invocations.
    pub fn used(self, invocations: u32) -> u64 {
        4 * u64::from(START + invocations.min(self.fragments()) * self.part())
    }

    /// The module of a stage with the address of the log, and these places.
    pub(super) fn finish(self, words: &[u32], address: u64) -> Option<Vec<u32>> {
        let values = [
            address as u32,
            (address >> 32) as u32,
            self.kept,
            self.kept - 1,
            self.stride(),
            self.part(),
            self.fragments(),
            self.first_call(),
            self.first_event(),
        ];
        let changes: Vec<(u32, u32)> = (FIRST_LATER..).zip(values).collect();
        with_constants(words, &changes)
    }

    /// Reads a log, of which the words behind the last invocation may be missing. Returns the invocations, and how many were left out.
    pub fn decode(self, words: &[u32]) -> (Vec<LoggedFragment>, u32) {
        let count = words.first().copied().unwrap_or(0);
        let parts = words.get(START as usize..).unwrap_or_default().chunks_exact(self.part() as usize);
        let kept = count.min(self.fragments());
        (parts.take(kept as usize).map(|part| self.fragment(part)).collect(), count - kept)
    }

    fn fragment(self, part: &[u32]) -> LoggedFragment {
        let counts = &part[HEADER as usize..self.first_call() as usize];
        let calls = kept(part[6], MOST_CALLS).map(|(number, slot)| {
            let at = (self.first_call() + CALL * slot) as usize;
            LoggedCall { number: number + 1, caller: part[at], point: part[at + 1], light: part[at + 2], lost: 0 }
        });
        let mut calls: Vec<LoggedCall> = calls.collect();
        let mut entered: HashMap<u32, u32> = HashMap::new();
        calls.iter().for_each(|call| *entered.entry(call.point).or_default() += 1);
        for call in &mut calls {
            call.lost = counts.get(call.point as usize).map_or(0, |count| count.saturating_sub(entered[&call.point]));
        }
        let mut events: Vec<(u32, LoggedEvent)> = Vec::new();
        for (point, &count) in (0..).zip(counts).filter(|(point, _)| !entered.contains_key(point)) {
            events.extend(kept(count, self.kept).map(|(number, slot)| {
                let at = (self.first_event() + self.stride() * point + EVENT * slot) as usize;
                let lost = if number + 1 == self.kept { count.saturating_sub(2 * self.kept) } else { 0 };
                let bits = [part[at + 2], part[at + 3], part[at + 4], part[at + 5]];
                (part[at], LoggedEvent { point, call: part[at + 1], bits, lost })
            }));
        }
        events.sort_by_key(|(number, _)| *number);
        LoggedFragment {
            number: part[0],
            color: (part[1] != 0).then(|| [part[2], part[3], part[4], part[5]]),
            samples: (part[7] != 0).then_some(part[7]),
            primitive: part[8].checked_sub(1),
            calls,
            events: events.into_iter().map(|(_, event)| event).collect(),
        }
    }
}

/// The numbers from 0 of the entries that a list has kept, the first `most` and the last, with their slots.
fn kept(count: u32, most: u32) -> impl Iterator<Item = (u32, u32)> {
    let first = (0..count.min(most)).map(|number| (number, number));
    let last = most.max(count.saturating_sub(most))..count;
    first.chain(last.map(move |number| (number, most + number % most)))
}

/// The first words of an empty log of these invocations.
pub fn empty(of: Invocations) -> [u32; START as usize] {
    let [a, b, c] = of.words();
    [0, a, b, c]
}

/// The log of one invocation.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedFragment {
    /// Of a fragment, the bits of its depth; of a vertex, its index.
    pub number: u32,
    /// The bits of its color, or of its position in clip space; `None` if it was discarded.
    pub color: Option<[u32; 4]>,
    /// The samples that a fragment covers, as bits; `None` for other invocations.
    pub samples: Option<u32>,
    /// The number of a fragment's primitive in its draw, from 0, if the stage gets it.
    pub primitive: Option<u32>,
    /// The first and the last calls of functions, in order.
    pub calls: Vec<LoggedCall>,
    /// The first and the last events of each log point, in the order of execution.
    pub events: Vec<LoggedEvent>,
}

/// A call of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoggedCall {
    /// From 1.
    pub number: u32,
    /// The number of the call that made it; 0 for none.
    pub caller: u32,
    /// The number of the log point at which the function begins.
    pub point: u32,
    /// The number of the light that it is about, from 0.
    pub light: u32,
    /// How many calls of the same function were not kept.
    pub lost: u32,
}

/// An event at a log point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoggedEvent {
    /// The number of the log point.
    pub point: u32,
    /// The number of its call; 0 for none.
    pub call: u32,
    /// Its value.
    pub bits: [u32; 4],
    /// How many events of the point came between this one and the next that was kept.
    pub lost: u32,
}

impl TracedStage {
    /// The places of the log that it writes.
    pub fn layout(&self) -> Layout {
        Layout::new(self.point_count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_is_read_as_it_was_written() {
        let layout = Layout::new(3);
        let mut words = vec![0; WORDS as usize];
        words[..START as usize].copy_from_slice(&[MOST_FRAGMENTS + 2, 0, 1, 0]);
        let part = &mut words[(START + layout.part()) as usize..];
        part[..HEADER as usize].copy_from_slice(&[0.5_f32.to_bits(), 1, 2, 3, 4, 5, 1, 0b101, 8]);
        part[layout.first_call() as usize..][..CALL as usize].copy_from_slice(&[0, 2, 7]);
        // The first point has been reached once, the last one twice, before and behind that. The function of the second has begun.
        part[HEADER as usize..][..4].copy_from_slice(&[0, 1, 4, 2]);
        let event = |point: u32, slot: u32| (layout.first_event() + layout.stride() * point + EVENT * slot) as usize;
        part[event(3, 0)..][..EVENT as usize].copy_from_slice(&[0, 0, 1, 2, 3, 4]);
        part[event(1, 0)..][..EVENT as usize].copy_from_slice(&[1, 1, 5, 0, 0, 0]);
        part[event(3, 1)..][..EVENT as usize].copy_from_slice(&[2, 0, 6, 0, 0, 0]);
        let (fragments, left_out) = layout.decode(&words);
        assert_eq!((fragments.len(), left_out), (MOST_FRAGMENTS as usize, 2));
        let event = |point, call, bits| LoggedEvent { point, call, bits, lost: 0 };
        let expected = LoggedFragment {
            number: 0.5_f32.to_bits(),
            color: Some([2, 3, 4, 5]),
            samples: Some(0b101),
            primitive: Some(7),
            calls: vec![LoggedCall { number: 1, caller: 0, point: 2, light: 7, lost: 3 }],
            events: vec![event(3, 0, [1, 2, 3, 4]), event(1, 1, [5, 0, 0, 0]), event(3, 0, [6, 0, 0, 0])],
        };
        assert_eq!((&fragments[1], fragments[0].color), (&expected, None));
        assert_eq!(layout.decode(&[]), (Vec::new(), 0));
        // Less is read where fewer invocations were logged.
        words[0] = 2;
        words.truncate(layout.used(2) as usize / 4);
        assert_eq!(layout.decode(&words).0[1], expected);
    }

    #[test]
    fn the_first_and_the_last_of_a_long_list_are_kept() {
        let all = |count: u32| kept(count, 4).collect::<Vec<_>>();
        assert_eq!(all(2), [(0, 0), (1, 1)]);
        assert_eq!(all(7), [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (5, 5), (6, 6)]);
        assert_eq!(all(11), [(0, 0), (1, 1), (2, 2), (3, 3), (7, 7), (8, 4), (9, 5), (10, 6)]);
    }

    #[test]
    fn a_log_is_bounded_and_keeps_sixteen_of_each_end() {
        for points in [0, 1, 40, 400, 1200, 2000, MOST_POINTS as usize - 1] {
            let layout = Layout::new(points);
            assert!(layout.kept >= LEAST_KEPT && layout.kept.is_power_of_two(), "{points}");
            assert!(layout.fragments() >= 2 && layout.used(u32::MAX) <= SIZE, "{points}");
            assert!(points > 1200 || layout.fragments() == MOST_FRAGMENTS, "{points}");
            let end = layout.cleared().last().unwrap();
            assert!(end.0 + end.1 as u64 <= SIZE, "{points}");
        }
        assert_eq!(Layout::new(100).kept, 128);
    }
}
