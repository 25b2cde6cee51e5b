//! The program as a process: options, files, exit codes, messages, and what the README promises.

mod cli;
mod files;
mod learn;
mod probe;
mod readme;
mod watch;
