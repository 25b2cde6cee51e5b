//! `specula lsp`: the language server, over the real program's stdin and stdout.

mod actions;
mod client;
mod code_server;
mod corners;
mod diagnostics;
mod hints;
mod names;
mod neovim;
mod rename;
mod vscode;
