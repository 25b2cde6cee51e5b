//! Whether anybody reads standard output.

#[cfg(target_os = "linux")]
use std::os::fd::{AsFd as _, BorrowedFd};

#[cfg(target_os = "linux")]
use rustix::event::Timespec;

/// Waits until nobody reads the events of a window whose standard input has ended, if both are pipes: the program that has started the window
/// holds both until its own end. Returns `false` at once if another input or output says nothing about that.
#[cfg(target_os = "linux")]
pub(in crate::commands) fn wait_for_end_of_program() -> bool {
    use rustix::fs::{FileType, fstat};
    let is_pipe = |file: BorrowedFd<'_>| {
        let kind = fstat(file).map(|status| FileType::from_raw_mode(status.st_mode));
        kind.is_ok_and(|kind| matches!(kind, FileType::Fifo | FileType::Socket))
    };
    let both = is_pipe(std::io::stdin().as_fd()) && is_pipe(std::io::stdout().as_fd());
    both && loop {
        match unread(None) {
            Err(rustix::io::Errno::INTR) => {}
            other => break other == Ok(true),
        }
    }
}

#[cfg(not(target_os = "linux"))]
pub(in crate::commands) fn wait_for_end_of_program() -> bool {
    false
}

/// Whether standard output is a pipe that nobody reads any more.
#[cfg(target_os = "linux")]
pub(super) fn nobody_reads() -> bool {
    unread(Some(&Timespec { tv_sec: 0, tv_nsec: 0 })) == Ok(true)
}

/// Waits, at most for some time, until nobody reads standard output any more.
#[cfg(target_os = "linux")]
fn unread(most: Option<&Timespec>) -> rustix::io::Result<bool> {
    use rustix::event::{PollFd, PollFlags, poll};
    let stdout = std::io::stdout();
    let mut watched = [PollFd::new(&stdout, PollFlags::empty())];
    let count = poll(&mut watched, most)?;
    Ok(count > 0 && watched[0].revents().intersects(PollFlags::ERR | PollFlags::HUP))
}

#[cfg(not(target_os = "linux"))]
pub(super) fn nobody_reads() -> bool {
    false
}
