//! From a file to JSON and bytes: the container, its buffers, and the files that it names.

pub mod buffers;
pub mod container;
pub mod uri;
