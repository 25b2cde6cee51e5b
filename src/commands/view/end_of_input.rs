//! The end of standard input ends a session without a window: once the commands before it are answered, or at once if nobody reads the answers.

use specula::control::{Client, Control};

use super::output::nobody_reads;
use super::supervisor;

/// The last line.
const QUIT: &str = r#"{"command": "quit"}"#;

/// Reads commands from standard input to its end, and then ends the session.
pub(super) fn read(control: &Control, stdout: Client, is_supervised: bool) {
    let parent = parent();
    let is_alone = move || (is_supervised && self::parent() != parent) || nobody_reads();
    control.read(std::io::stdin(), stdout, move |client| {
        // After the end of its parent, the pipe has ended, too.
        if !is_alone() {
            client.wait_for_answers(is_alone);
        }
        if is_alone() {
            supervisor::end();
        }
        Some(QUIT.to_owned())
    });
}

/// The number of the process that has started this one; another one takes its place after its end.
#[cfg(unix)]
fn parent() -> u32 {
    std::os::unix::process::parent_id()
}

#[cfg(not(unix))]
fn parent() -> u32 {
    0
}
