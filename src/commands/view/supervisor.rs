//! Runs the window as a child process, and starts another one when the device is lost or the driver crashes. A lost device cannot
//! always be made again in the same process, and a crash leaves no process to do it in.
//!
//! The child has the same arguments, terminal and process group. Its standard input is a pipe: it closes when this process ends,
//! however it ends, and then the child ends too. With `--events json`, the commands that come on this process's standard input go
//! through the pipe line by line. A command that arrives while one child takes the place of another waits for the new one.

use std::fs::DirBuilder;
use std::io::{self, BufRead as _, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{ChildStdin, Command, ExitStatus, Stdio};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use specula::control::{MOST_BYTES, remove_sockets};
use specula::message;
use specula::process_end::end_process;
use specula::recovery::{GoodTexts, HUNG, LOST, MOST_LOSSES, RecoveryState, VARIABLE, keep_typed, remove_folder};

use super::output::wait_for_end_of_program;
use crate::commands::Failure;

/// Longer lines are forwarded in parts. The child refuses them anyway.
const LONGEST_LINE: u64 = MOST_BYTES as u64 + 1;

/// Exit code of a process whose main thread has panicked.
const PANICKED: i32 = 101;

/// The folder of the session, if this process is the child.
pub fn session() -> Option<PathBuf> {
    std::env::var_os(VARIABLE).map(PathBuf::from)
}

/// The use of this process's standard input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Forward {
    /// Nobody reads it.
    Nothing,
    /// The child gets its lines. Its end ends nothing.
    Lines,
    /// The child gets its lines and its end.
    All,
}

/// Runs the window in child processes until one ends by itself. `in_place` runs it in this process, if there can be no child.
pub fn run(forwards: Forward, in_place: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    let input = Input::default();
    let child = create_folder().and_then(|folder| {
        let program = std::env::current_exe()?;
        let result = run_child(&program, &folder.0, &input, forwards)?;
        Ok((folder, program, result))
    });
    let (folder, program, mut status) = match child {
        Ok(child) => child,
        Err(error) => {
            message::warn(format_args!(
                "without a process of its own ({error}), the window ends if the device is lost"
            ));
            return in_place();
        }
    };
    while let Some(cause) = cause_of_loss(status) {
        let state = RecoveryState::read(&folder.0);
        if state.is_closed {
            message::warn(format_args!("{cause} while the window closed"));
            return Ok(());
        }
        let tree = state.work.as_ref().and_then(|work| work.tree.clone());
        let state = match state.losses {
            0 if is_unexplained(status) => state.after_panic(&cause),
            _ => state.after_loss(&cause, &GoodTexts::read(&folder.0, tree.as_deref())),
        };
        if state.losses >= MOST_LOSSES {
            return Err(Failure::Device(farewell(&cause, &state, &keep_typed(&folder.0))));
        }
        message::tell(format_args!("{cause}; the session goes on in a new process"));
        let next = state.write(&folder.0).and_then(|()| run_child(&program, &folder.0, &input, forwards));
        status = next.map_err(|error| Failure::Device(format!("{cause}, and the session cannot go on: {error}")))?;
    }
    drop(folder);
    end_like(status)
}

/// Ends the child when its parent ends, if nobody else reads the pipe between them.
pub fn end_with_parent() {
    let wait = || {
        // The pipe holds nothing, so this returns once it is closed.
        let _ = io::stdin().read(&mut [0]);
        end();
    };
    // Without the thread, only a killed parent would leave the child behind.
    let _ = std::thread::Builder::new().name("specula-parent".to_owned()).spawn(wait);
}

/// Wakes the child, if it is stopped, when its parent ends, so that it sees the end of the pipe.
pub fn wake_with_parent() {
    #[cfg(target_os = "linux")]
    let _ = rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::CONT));
}

/// Ends the child, whose parent has ended.
pub fn end() {
    let _halt = specula::picture::remove_unfinished();
    clean_up();
    #[cfg(unix)]
    let _ = signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTERM);
    end_process(1);
}

/// Removes the sockets, and the folder of the session if this process is the child, before a signal ends it.
pub fn clean_up() {
    remove_sockets();
    session().iter().for_each(|folder| remove_folder(folder));
}

/// A folder that is removed with its value.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        remove_folder(&self.0);
    }
}

/// A new folder that only the user may read. On a file system in memory if there is one, since a disk takes milliseconds to
/// replace a file.
fn create_folder() -> io::Result<Folder> {
    let in_memory = [std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from), Some(PathBuf::from("/dev/shm"))];
    let parent = in_memory.into_iter().flatten().find(|path| path.is_dir()).unwrap_or_else(std::env::temp_dir);
    remove_abandoned(&parent);
    let mut builder = DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    // An earlier process with the same number may have left its folder behind.
    let name = |attempt: u32| parent.join(format!("specula-{}-{attempt}", std::process::id()));
    let mut result = Err(io::ErrorKind::AlreadyExists.into());
    for path in (0..100).map(name) {
        result = builder.create(&path).map(|()| Folder(path));
        if !matches!(&result, Err(error) if error.kind() == io::ErrorKind::AlreadyExists) {
            break;
        }
    }
    result
}

/// Removes the folders of sessions whose supervisor and child were both killed.
fn remove_abandoned(parent: &Path) {
    let has_ended = |folder: &Path| {
        let name = folder.file_name()?.to_str()?.strip_prefix("specula-")?;
        let process: u32 = name.split_once('-')?.0.parse().ok()?;
        Some(Path::new("/proc/self").exists() && !Path::new(&format!("/proc/{process}")).exists())
    };
    let folders = std::fs::read_dir(parent).into_iter().flatten().flatten().map(|entry| entry.path());
    folders.filter(|folder| has_ended(folder) == Some(true)).for_each(|folder| remove_folder(&folder));
}

/// Runs the program again with the same arguments, to its end.
fn run_child(program: &Path, folder: &Path, input: &Input, forwards: Forward) -> io::Result<ExitStatus> {
    let mut child =
        Command::new(program).args(std::env::args_os().skip(1)).env(VARIABLE, folder).stdin(Stdio::piped()).spawn()?;
    input.lead_to(child.stdin.take());
    if forwards != Forward::Nothing {
        input.forward(forwards);
    }
    let status = child.wait();
    input.lead_to(None);
    status
}

/// Forwards standard input to the child.
#[derive(Clone, Default)]
struct Input(Arc<(Mutex<Lead>, Condvar)>);

/// Where the input goes.
#[derive(Default)]
struct Lead {
    pipe: Option<ChildStdin>,
    is_read: bool,
    /// Whether no child gets any more.
    has_ended: bool,
}

impl Input {
    fn lock(&self) -> MutexGuard<'_, Lead> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Leads the input to another child, or lets it wait. After the end of the input, the pipe to the child is closed.
    fn lead_to(&self, pipe: Option<ChildStdin>) {
        let mut lead = self.lock();
        lead.pipe = pipe.filter(|_| !lead.has_ended);
        self.0.1.notify_all();
    }

    /// Ends the input of the child, and of the next ones.
    fn end(&self) {
        let mut lead = self.lock();
        (lead.pipe, lead.has_ended) = (None, true);
    }

    /// Reads standard input on a thread until it ends. The thread is started once.
    fn forward(&self, forwards: Forward) {
        if std::mem::replace(&mut self.lock().is_read, true) {
            return;
        }
        let input = self.clone();
        let read = move || {
            let (mut lines, mut line) = (io::stdin().lock(), Vec::new());
            while (&mut lines).take(LONGEST_LINE).read_until(b'\n', &mut line).is_ok_and(|count| count > 0) {
                // The last line may lack its end, and the next child's input goes on.
                if line.len() < LONGEST_LINE as usize && !line.ends_with(b"\n") {
                    line.push(b'\n');
                }
                input.pass(&line);
                line.clear();
            }
            if forwards == Forward::All || wait_for_end_of_program() {
                input.end();
            }
        };
        // If the thread cannot start, the window gets no commands from this input.
        let _ = std::thread::Builder::new().name("specula-input".to_owned()).spawn(read);
    }

    /// Passes a line on to the child, or to the next one if the child has ended. What a child has not read at its end is lost.
    fn pass(&self, line: &[u8]) {
        let mut lead = self.lock();
        loop {
            match lead.pipe.as_mut().map(|pipe| pipe.write_all(line)) {
                Some(Ok(())) => return,
                Some(Err(_)) => lead.pipe = None,
                None => lead = self.0.1.wait(lead).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }
}

/// Why the device or the program was lost, as the start of a sentence; `None` if the child has ended by itself or was ended by
/// the user.
fn cause_of_loss(status: ExitStatus) -> Option<String> {
    match status.code() {
        Some(code) if code == i32::from(LOST) => Some("the graphics device was lost".to_owned()),
        Some(code) if code == i32::from(HUNG) => Some("the graphics device did not answer".to_owned()),
        Some(PANICKED) => Some("Specula failed".to_owned()),
        code => crash(status, code),
    }
}

/// Whether neither a text nor a setting is suspected: a panic is a fault of Specula, and somebody else kills a process.
fn is_unexplained(status: ExitStatus) -> bool {
    #[cfg(unix)]
    let is_killed = std::os::unix::process::ExitStatusExt::signal(&status) == Some(signal_hook::consts::SIGKILL);
    #[cfg(not(unix))]
    let is_killed = false;
    is_killed || status.code() == Some(PANICKED)
}

/// The signal of a crash, as a driver may cause it, or by which the system ends a process.
#[cfg(unix)]
fn crash(status: ExitStatus, _: Option<i32>) -> Option<String> {
    use signal_hook::consts::{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGKILL, SIGSEGV, SIGSYS, SIGTRAP};
    use std::os::unix::process::ExitStatusExt as _;
    if status.signal() == Some(SIGKILL) {
        return Some("the program was killed (SIGKILL), as the system does when memory is short".to_owned());
    }
    let crashes = [SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGSYS, SIGTRAP];
    let signal = status.signal().filter(|signal| crashes.contains(signal))?;
    Some(format!("the program crashed ({})", signal_hook::low_level::signal_name(signal).unwrap_or("a signal")))
}

/// An exit code of Windows for an exception, as a driver may cause it: an NTSTATUS of severity "error".
#[cfg(not(unix))]
fn crash(_: ExitStatus, code: Option<i32>) -> Option<String> {
    let code = code.filter(|code| code.cast_unsigned() >> 30 == 3)?;
    Some(format!("the program crashed ({:#x})", code.cast_unsigned()))
}

/// Why the session ends.
/// `kept`: the files with the texts that were not saved.
fn farewell(cause: &str, state: &RecoveryState, kept: &[PathBuf]) -> String {
    let refused: Vec<&str> = state.quarantined.keys().map(String::as_str).collect();
    let advice = match refused.as_slice() {
        [] => "Another program may have caused it; try `--device NAME` or `--env none`".to_owned(),
        refused => format!("Undo the last edits of {} before you start again", refused.join(", ")),
    };
    let kept: Vec<String> = kept.iter().map(|path| path.display().to_string()).collect();
    let typed = match kept.as_slice() {
        [] => String::new(),
        kept => format!(" What you typed and did not save is in {}.", kept.join(", ")),
    };
    format!("{cause}, the third time in a row, so the session ends. Your files are as you saved them.{typed} {advice}")
}

/// Ends this process as the child has ended.
fn end_like(status: ExitStatus) -> Result<(), Failure> {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let _ = signal_hook::low_level::emulate_default_handler(signal);
    }
    match status.code() {
        Some(0) => Ok(()),
        Some(code) => Err(Failure::Window(u8::try_from(code).unwrap_or(1))),
        None => Err(Failure::Printed),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_line_for_a_child_that_has_ended_goes_to_the_next() {
        let spawn = |program: &str| Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (input, mut ended) = (Input::default(), spawn("true"));
        let pipe = ended.stdin.take();
        ended.wait().unwrap();
        input.lead_to(pipe);
        let forwards = input.clone();
        let forwarding = std::thread::spawn(move || forwards.pass(b"a command\n"));
        while input.lock().pipe.is_some() {
            std::thread::yield_now();
        }
        let mut next = spawn("cat");
        input.lead_to(next.stdin.take());
        forwarding.join().unwrap();
        input.lead_to(None);
        assert_eq!(next.wait_with_output().unwrap().stdout, b"a command\n");
    }
}
