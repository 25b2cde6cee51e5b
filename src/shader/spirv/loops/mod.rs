//! Bounds the loops of a module: every invocation counts the rounds of all loops whose end is not plain to see, and
//! leaves them when its budget is used up. On a GPU an endless loop would hang the device, and the process with it.
//!
//! The counter is a private variable, so nested loops and loops in functions share the budget. A loop that takes a
//! small constant number of rounds is left as it is, and so is a module that has no other. When the budget runs out,
//! the invocation names the loop in a storage buffer before it ends.
//!
//! A loop counts as plainly bounded (`rounds.rs`) if one store per iteration changes its variable, and its first value,
//! step and limit are constants, or its limit has a constant bound as in `i < min(count, 200u)`, and it takes at most
//! 32,768 iterations, with the loops inside it. The default picture has no other loops, so it pays nothing. Where an
//! invocation that ran out of its limit ends, it marks its fragment magenta. The loop that it names is the innermost
//! one that took half of the limit since it was entered. Invocations that begin later have a small limit, so the time
//! of an endless loop does not grow with the image.
//!
//! |  | iterations | after the first overrun |
//! |---|---|---|
//! | pixels, vertices, patches and primitives on a GPU | 262,144 | 1,024 |
//! | bakes on a GPU | 1,048,576 | 1,024 |
//! | lavapipe | 49,152 | 256 |
//!
//! Limits:
//!
//! - The limit counts iterations, not time: iterations of a thousand instructions each can still hold a GPU for
//!   seconds.
//! - A compute loop with barriers whose invocations leave it at different iterations is undefined, and may hang.
//! - lavapipe reads 0 from buffers in helper invocations, so these have the small limit from the start: after a loop of
//!   more than 256 counted iterations, derivatives at the edge of a triangle may be wrong there.
//! - lavapipe itself ends all loops of an invocation after 65,535 iterations without a message. A path takes some
//!   hundred iterations per reflection, so `view.bounces` above 64 is refused.

mod bounds;
mod place;
mod plan;
mod rewrite;
mod rounds;

pub use bounds::Bounds;
pub use place::{LoopPlace, Overrun};
pub use rewrite::bound;

#[cfg(test)]
mod tests;
