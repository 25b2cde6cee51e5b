//! Compiles files to SPIR-V: shader trees, compilation, diagnostics, annotations and the check against the contract.
//!
//! This module uses no Vulkan device and no scene. An edit takes this path: [`watch`] delivers a settled set of changed paths.
//! [`library`] finds the dirty stages in the include graph, compiles them ([`compile`]), reflects the modules
//! ([`spirv::reflect`]), checks them against the contract ([`contract`]) and reads the annotations ([`annotation`]). The result
//! is either a complete new [`ShaderSet`] or [`Diagnostic`]s.

pub mod annotation;
pub mod checks;
pub mod compile;
pub mod contract;
pub mod costs;
pub mod diagnostic;
pub mod expression;
pub(crate) mod glsl;
pub mod graph;
mod includes;
mod incremental;
pub mod library;
pub mod not_finite;
mod pixel;
pub mod rewrite;
pub mod source;
pub mod spirv;
pub mod symbols;
pub mod trace;
pub mod values;
pub mod watch;

pub use annotation::{Constant, DrawAs, Encode, Mode, Numbers, PATHS_STAGE, Parameter};
pub use compile::{Compiler, StageKind};
pub use diagnostic::{Diagnostic, Severity};
pub use expression::{Expression, Watching};
pub use glsl::{Highlight, highlights, includes};
pub use graph::{Graph, GraphPass};
pub use includes::IncludeGraph;
pub use library::{Change, Library, Report, ShaderSet, Stage, Update, check};
pub use not_finite::FirstNotFinite;
pub use pixel::PixelValue;
pub use source::quarantine::text_hash;
pub use source::{BUILT_IN, Source, SourceError, TreePath, embedded, is_specula_tree, leads_out};
pub use spirv::specialize;
pub use trace::Site;
pub use watch::{Batch, Watcher};
