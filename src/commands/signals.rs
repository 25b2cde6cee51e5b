//! Signals that end the program: temporary files are removed before.

/// Starts a thread that waits for SIGHUP, SIGINT and SIGTERM, removes unfinished pictures, and lets the signal end the program by
/// its default action.
#[cfg(unix)]
pub fn clean_up_on_end() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let clean_up = || {
        let signals = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
        let signal = Signals::new(signals).ok().and_then(|mut signals| signals.forever().next());
        if let Some(signal) = signal {
            let _halt = specula::picture::remove_unfinished();
            super::view::supervisor::clean_up();
            specula::mcp::remove_temporary();
            // The process is gone after this.
            let _ = emulate_default_handler(signal);
        }
    };
    // If the thread cannot start, signals end the program as they do by default.
    let _ = std::thread::Builder::new().name("specula-signals".to_owned()).spawn(clean_up);
}

/// Other systems end programs differently.
#[cfg(not(unix))]
pub fn clean_up_on_end() {}

/// Whether the parent process wants the program to ignore a signal, as `nohup` and background jobs of shells do. Linux only;
/// elsewhere, no signal counts as ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    (mask >> (signal - 1)) & 1 == 1
}
