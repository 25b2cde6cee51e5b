//! Files to SPIR-V: shader trees, compilation, diagnostics, annotations and the check against the contract.
//!
//! Knows no Vulkan device and no scene. The way of an edit:
//! [`watch`] delivers settled sets of changed paths; [`library`] finds the dirty stages through the include graph, compiles
//! them ([`compile`]), reflects the modules ([`reflect`]), holds them against the contract ([`contract`]) and reads the
//! author's annotations ([`annotation`]); out comes either a whole new [`ShaderSet`] or [`Diagnostic`]s, never a mixture.

pub mod annotation;
mod annotation_cursor;
mod annotation_parse;
mod annotation_value;
mod capability;
pub mod check;
pub mod compile;
mod conditions;
pub mod contract;
mod declared;
pub mod diagnostic;
mod directory;
pub mod embedded;
mod fingerprint;
pub mod include;
mod layout;
pub mod library;
pub mod log;
mod opcode;
pub mod reflect;
mod slot;
pub mod snapshot;
pub mod source;
mod specialize;
mod text;
pub mod watch;

pub use annotation::{Constant, DrawAs, Encode, Mode, Parameter};
pub use compile::{Compiler, StageKind};
pub use diagnostic::{Diagnostic, Severity};
pub use library::{Change, Library, Report, ShaderSet, Update};
pub use slot::Stage;
pub use source::{Source, SourceError, TreePath, is_specula_tree};
pub use specialize::specialize;
pub use watch::{Batch, Watcher};
