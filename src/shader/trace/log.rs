//! The log that a traced stage writes: what each of the chosen invocations does.

use super::Invocations;
use super::stage::Listener;
use crate::shader::StageKind;
use crate::shader::spirv::trace::{Logged, with_constants};

/// Most invocations that are logged: fragments of a pixel, or vertices of a triangle with the times that each is drawn.
pub const MOST_FRAGMENTS: u32 = 16;
/// Most events of an invocation that are logged. The others are counted.
pub const MOST_EVENTS: u32 = 1 << 14;
/// More than the largest number of a log point.
pub const MOST_POINTS: u32 = 1 << 13;
/// Words before the first invocation: how many there are, and [`Invocations::words`].
const START: usize = 4;
/// Words of an invocation before its counters: its number, whether it came to its end, and its result.
const HEADER: usize = 6;
/// Words of an event: the number of its log point, which is never 0, and the bits of up to four numbers.
const EVENT: usize = 5;
/// Words before the events. The counters are of events that found the log full, by log points.
const BEFORE_EVENTS: usize = HEADER + MOST_POINTS as usize;
/// Words of an invocation.
const PART: usize = BEFORE_EVENTS + EVENT * MOST_EVENTS as usize;
/// Bytes of a log.
pub const SIZE: u64 = 4 * (START + MOST_FRAGMENTS as usize * PART) as u64;
/// Numbers in the text that stand for the address of the log.
const ADDRESS: [u32; 2] = [0xC0DE_0A01, 0xC0DE_0A02];
/// The function that logs an event.
pub(super) const FUNCTION: &str = "specula_trace";
/// Extensions for a text that writes to a buffer by its address.
pub const EXTENSIONS: &str = "#extension GL_EXT_buffer_reference : require\n#extension GL_EXT_buffer_reference_uvec2 : require\n\
    #extension GL_EXT_scalar_block_layout : require";

/// The text that writes the log of a stage of this kind, and of its `color` if it has one. `None` for kinds that are not traced.
pub(super) fn listener(kind: StageKind, color: Option<&str>) -> Option<Listener> {
    // Which invocation is logged, its number, and its result.
    let [is_logged, own_number, result] = match kind {
        StageKind::Fragment => [
            "!gl_HelperInvocation && uvec2(gl_FragCoord.xy) == logged.xy",
            "floatBitsToUint(gl_FragCoord.z)",
            color.unwrap_or("vec4(0.0)"),
        ],
        StageKind::Vertex => ["any(equal(uvec3(gl_VertexIndex), logged))", "uint(gl_VertexIndex)", "gl_Position"],
        StageKind::Compute => ["gl_GlobalInvocationID == logged", "0u", "vec4(0.0)"],
        _ => return None,
    };
    let number = |number: u32| format!("{number}u");
    let text = include_str!("log.glsl")
        .replace("SPECULA_LOW", &number(ADDRESS[0]))
        .replace("SPECULA_HIGH", &number(ADDRESS[1]))
        .replace("SPECULA_EVENTS", &number(MOST_EVENTS))
        .replace("SPECULA_POINTS", &number(MOST_POINTS))
        .replace("SPECULA_FRAGMENTS", &number(MOST_FRAGMENTS))
        .replace("SPECULA_HEADER", &number(HEADER as u32))
        .replace("SPECULA_PART", &number(PART as u32))
        .replace("SPECULA_IS_LOGGED", is_logged)
        .replace("SPECULA_NUMBER", own_number)
        .replace("SPECULA_RESULT", result);
    Some(Listener { text, extensions: EXTENSIONS, function: FUNCTION, logged: Logged::Statements })
}

/// The module with the address of the log.
pub(super) fn with_address(words: &[u32], address: u64) -> Option<Vec<u32>> {
    let [low, high] = [address as u32, (address >> 32) as u32];
    with_constants(words, &[(ADDRESS[0], low), (ADDRESS[1], high)])
}

/// The first words of an empty log of these invocations. All others are 0.
pub fn empty(of: Invocations) -> [u32; START] {
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
    /// The numbers of the log points and their bits, in order.
    pub events: Vec<(u32, [u32; 4])>,
    /// The numbers of log points, and how many of their events found the log full.
    pub left_out: Vec<(u32, u32)>,
}

/// Reads a log. Returns the invocations, and how many were left out.
pub fn decode(words: &[u32]) -> (Vec<LoggedFragment>, u32) {
    let count = words.first().copied().unwrap_or(0);
    let parts = words.get(START..).unwrap_or_default().chunks_exact(PART);
    let fragment = |part: &[u32]| {
        let events = part[BEFORE_EVENTS..].chunks_exact(EVENT).take_while(|event| event[0] != 0);
        let left_out = (0..).zip(&part[HEADER..BEFORE_EVENTS]).filter(|(_, count)| **count > 0);
        LoggedFragment {
            number: part[0],
            color: (part[1] != 0).then(|| [part[2], part[3], part[4], part[5]]),
            events: events.map(|event| (event[0], [event[1], event[2], event[3], event[4]])).collect(),
            left_out: left_out.map(|(point, count)| (point, *count)).collect(),
        }
    };
    (parts.take(count as usize).map(fragment).collect(), count.saturating_sub(MOST_FRAGMENTS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_is_read_as_it_was_written() {
        let mut words = vec![0; SIZE as usize / 4];
        words[..START].copy_from_slice(&[MOST_FRAGMENTS + 2, 0, 1, 0]);
        let second = START + PART;
        words[second..second + HEADER].copy_from_slice(&[0.5_f32.to_bits(), 1, 2, 3, 4, 5]);
        words[second + HEADER + 7] = 9;
        words[second + BEFORE_EVENTS..][..2 * EVENT].copy_from_slice(&[3, 1, 2, 3, 4, 8, 5, 0, 0, 0]);
        let (fragments, left_out) = decode(&words);
        assert_eq!((fragments.len(), left_out), (MOST_FRAGMENTS as usize, 2));
        let expected = LoggedFragment {
            number: 0.5_f32.to_bits(),
            color: Some([2, 3, 4, 5]),
            events: vec![(3, [1, 2, 3, 4]), (8, [5, 0, 0, 0])],
            left_out: vec![(7, 9)],
        };
        assert_eq!((&fragments[1], fragments[0].color), (&expected, None));
        assert_eq!(decode(&[]), (Vec::new(), 0));
    }
}
