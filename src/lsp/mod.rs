//! A language server for shader trees, over stdio: `specula lsp`.
//!
//! The thread of the server (`server`) reads messages, keeps the texts of the editor (`documents`) and answers questions about names,
//! which need no compiler: a `view::View` has the files of a tree with what they declare (`shader::symbols`). Each tree has a thread
//! that compiles it with the editor's texts (`compiling`), as the window does, and gives diagnostics for all of its files. Another
//! thread draws and traces a pixel of the saved tree (`pixel_trace`) once one is pinned; its values stand beside the lines (`hints`).
//!
//! A message that is wrong gets an error as its answer, and a panic in an answer is one, too.

mod actions;
mod colors;
mod compiling;
mod completion;
mod diagnostics;
mod documents;
mod event;
mod following;
mod hints;
mod hover;
mod meaning;
mod name;
mod navigation;
mod notifications;
mod outline;
mod pixel_trace;
mod refreshes;
mod rename;
mod requests;
mod server;
mod signature;
mod source_file;
mod source_text;
mod state;
mod traced;
mod transport;
mod trees;
mod types;
mod uri;
mod values;

mod view;
mod window;

pub use pixel_trace::{OpenTree, text_of};
pub use server::{Config, OpenWindow, serve};

#[cfg(test)]
mod tests;
