//! The log that a traced stage writes: what each of its fragments at a pixel does.

use super::stage::Listener;
use crate::shader::spirv::trace::{Told, with_constants};

/// Most fragments of a pixel that are logged.
pub const MOST_FRAGMENTS: u32 = 16;
/// Most events of a fragment that are logged. The others are counted.
pub const MOST_EVENTS: u32 = 1 << 14;
/// Words before the first fragment: their number, the pixel, and one that is free.
const START: usize = 4;
/// Words before the events of a fragment: number of events, depth, whether it came to its end, color, and one that is free.
const HEADER: usize = 8;
/// Words of an event: the number of its telling, and the bits of up to four numbers.
const EVENT: usize = 5;
/// Words of a fragment.
const PART: usize = HEADER + EVENT * MOST_EVENTS as usize;
/// Bytes of a log.
pub const SIZE: u64 = 4 * (START + MOST_FRAGMENTS as usize * PART) as u64;
/// Numbers in the text that stand for the address of the log.
const ADDRESS: [u32; 2] = [0xC0DE_0A01, 0xC0DE_0A02];

/// The text that writes the log.
pub(super) fn listener() -> Listener {
    let number = |number: u32| format!("{number}u");
    let text = include_str!("log.glsl")
        .replace("SPECULA_LOW", &number(ADDRESS[0]))
        .replace("SPECULA_HIGH", &number(ADDRESS[1]))
        .replace("SPECULA_EVENTS", &number(MOST_EVENTS))
        .replace("SPECULA_FRAGMENTS", &number(MOST_FRAGMENTS))
        .replace("SPECULA_HEADER", &number(HEADER as u32))
        .replace("SPECULA_PART", &number(PART as u32));
    let extension = "#extension GL_EXT_buffer_reference_uvec2 : require";
    Listener { text, extension, function: "specula_trace", told: Told::All }
}

/// The module with the address of the log.
pub(super) fn with_address(words: &[u32], address: u64) -> Option<Vec<u32>> {
    let [low, high] = [address as u32, (address >> 32) as u32];
    with_constants(words, &[(ADDRESS[0], low), (ADDRESS[1], high)])
}

/// The first words of an empty log of this pixel.
pub fn empty(at: (u32, u32)) -> [u32; 4] {
    [0, at.0, at.1, 0]
}

/// What one fragment has done.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedFragment {
    /// Depth: 1 near, 0 at infinity.
    pub depth: f32,
    /// The bits of the color that it has written; `None` if it was discarded.
    pub color: Option<[u32; 4]>,
    /// The numbers of the tellings and their bits, in order.
    pub events: Vec<(u32, [u32; 4])>,
    /// Events that were left out.
    pub left_out: u32,
}

/// Reads a log. Returns the fragments, and how many were left out.
pub fn decode(words: &[u32]) -> (Vec<LoggedFragment>, u32) {
    let count = words.first().copied().unwrap_or(0);
    let parts = words.get(START..).unwrap_or_default().chunks_exact(PART);
    let fragment = |part: &[u32]| {
        let events = part[HEADER..].chunks_exact(EVENT).take(part[0] as usize);
        LoggedFragment {
            depth: f32::from_bits(part[1]),
            color: (part[2] != 0).then(|| [part[3], part[4], part[5], part[6]]),
            events: events.map(|event| (event[0], [event[1], event[2], event[3], event[4]])).collect(),
            left_out: part[0].saturating_sub(MOST_EVENTS),
        }
    };
    (parts.take(count as usize).map(fragment).collect(), count.saturating_sub(MOST_FRAGMENTS))
}
