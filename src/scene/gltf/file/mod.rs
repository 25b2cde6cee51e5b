//! From a file to JSON and bytes: the container, its buffers, and the files that it names.

mod archive;
pub mod buffers;
pub mod container;
pub mod opened;
pub mod uri;
