//! From SPIR-V to pipelines: one set for each shader generation, and the reload that makes the next set.

mod reload;
mod set;

pub use reload::{Outcome, Reload, Reloader, tree_name};
pub(crate) use set::BoundPipelines;
pub use set::{MEASURE_STAGES, PipelineSet, all_stages, stages};
