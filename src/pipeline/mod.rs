//! Pipelines: one set per shader generation, and the reload that creates the next set.

mod bounds;
mod disk;
mod limits;
mod reload;
mod set;
mod statistics_change;
mod textures;

pub use bounds::endless_loop;
pub use disk::DiskPipelines;
pub use limits::beyond_limits;
pub use reload::{Outcome, Reload, Reloader};
pub(crate) use set::BoundPipelines;
pub use set::{InPipeline, PipelineSet, StageReport};
pub use statistics_change::{Figure, all_statistics, figures};
pub use textures::PassTextures;
#[cfg(any(test, fuzzing))]
pub(crate) use textures::decode_table;
