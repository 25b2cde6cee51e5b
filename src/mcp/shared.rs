//! The state that all calls of a client share.

use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::places::Places;
use super::program::{Call, Program};

/// The program, the folders, and the calls that are open.
pub struct Shared {
    pub program: Program,
    pub places: Places,
    /// By the text of their id.
    pub calls: Mutex<HashMap<String, Arc<Call>>>,
    /// The texts of files as the agent has last seen or written them. Locked while an edit is under way, so that no other one begins with the
    /// text before it.
    pub seen: Mutex<HashMap<String, String>>,
    /// Files that the agent has made. Beside a single shader file, they belong to it only once it includes them.
    pub made: Mutex<HashSet<String>>,
    /// Locked while the picture is checked, which changes a setting meanwhile.
    pub checking: Mutex<()>,
}

/// Locks a value, also after a panic of another thread.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
