//! The program as a process: options, files, exit codes, messages, and what the README promises.

mod attacks;
mod bench;
mod cache;
mod checks;
mod cli;
mod cost;
mod files;
mod learn;
mod lsp;
mod mcp;
mod memory;
mod probe;
mod python;
mod readme;
mod serve;
mod trace;
mod watch;
