//! The budget of a module's loops.

/// How a module's loops are bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Rounds that an invocation may take in all of its bounded loops together.
    pub rounds: u32,
    /// The same once an invocation has used up its budget, so that one endless loop does not cost the whole budget in
    /// every pixel.
    pub rounds_after: u32,
    /// Descriptor set and binding of the buffer that names the loop: see [`Overrun`](super::Overrun). `None` if the stage cannot write
    /// buffers.
    pub report: Option<(u32, u32)>,
    /// Color of a fragment whose loops were cut short.
    pub mark: Option<[f32; 4]>,
}
