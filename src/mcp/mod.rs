//! A Model Context Protocol server for agents, on stdin and stdout: `specula mcp`.
//!
//! The client's messages are JSON-RPC 2.0, one object a line (`transport`, `message`). `server` answers them; what needs the program
//! runs on a thread of its own for each call. `program` is the other side: a `specula serve` that this process starts, or a window that
//! it joins. Both take the commands of `crate::app::command` as JSON lines, so this module knows neither window nor device. `tools` are
//! the tools that an agent sees, each a few commands.
//!
//! **Invariant:** A tool writes only to files of the shader tree and below the output folder (`places`). Pictures on their way to the
//! client pass through a private folder that ends with the process.
//! **Invariant:** Every request is answered exactly once, unless the client has canceled it.

mod diagnostics;
mod message;
mod places;
mod program;
mod resources;
mod server;
mod shared;
mod tools;
mod transport;

pub use places::remove_temporary;
pub use program::{Connection, Start};
pub use server::{Config, serve};
