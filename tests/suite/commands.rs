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
mod probe;
mod readme;
mod trace;
mod watch;
