//! Threads for work that lets the first picture go ahead. All other parallel work shares one pool, where it would wait for this.

use std::sync::LazyLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// `None` if the system grants no threads.
static POOL: LazyLock<Option<ThreadPool>> = LazyLock::new(|| {
    let name = |index| format!("specula-textures-{index}");
    ThreadPoolBuilder::new().thread_name(name).build().ok()
});

/// Does work, on these threads if `is_background`.
pub fn run_if<T: Send>(is_background: bool, work: impl FnOnce() -> T + Send) -> T {
    match POOL.as_ref().filter(|_| is_background) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}
