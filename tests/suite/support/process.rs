//! The program as a child process: run to its end, or driven by its events.

use std::ffi::OsStr;
use std::io::{BufRead as _, BufReader, Read, Write as _};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// How long anything may take before a test gives up. Nothing waits this long unless it hangs.
pub const PATIENCE: Duration = Duration::from_secs(90);

/// The output and exit status of a finished program.
#[derive(Debug)]
pub struct Finished {
    /// Exit code; `None` when a signal ended it.
    pub code: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Finished {
    /// Fails unless the program ended with `code` and said all of `parts` on stderr, without a panic.
    #[track_caller]
    pub fn expect(&self, code: i32, parts: &[&str]) -> &Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        assert!(!self.stderr.contains("panicked"), "{self:#?}");
        for part in parts {
            assert!(self.stderr.contains(part), "stderr lacks `{part}`: {self:#?}");
        }
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("stdout is no JSON ({error}): {self:#?}"))
    }
}

/// The program, to be run in `directory`.
pub fn specula(directory: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_specula"));
    command.current_dir(directory).stdin(Stdio::null());
    command
}

/// A shell that runs `command` as `"$0" "$@"`, in the same environment.
pub fn in_shell(command: &Command, script: &str) -> Command {
    let mut shell = Command::new("bash");
    shell.args(["-c", script]).arg(command.get_program()).args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => shell.env(name, value),
            None => shell.env_remove(name),
        };
    }
    shell
}

/// Runs the program to its end.
pub fn run<S: AsRef<OsStr>>(directory: &Path, args: &[S]) -> Finished {
    finish(specula(directory).args(args))
}

/// Runs a command to its end; one that hangs is killed and fails the test.
pub fn finish(command: &mut Command) -> Finished {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let collect = |mut pipe: Box<dyn Read + Send>| {
        let (sender, text) = channel();
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            let _ = pipe.read_to_end(&mut bytes);
            let _ = sender.send(String::from_utf8_lossy(&bytes).into_owned());
        });
        text
    };
    let stdout = collect(Box::new(child.stdout.take().unwrap()));
    let stderr = collect(Box::new(child.stderr.take().unwrap()));
    // The pipe closes when the program ends.
    let Ok(stdout) = stdout.recv_timeout(PATIENCE) else {
        let _ = child.kill();
        panic!("{command:?} did not end; stderr: {}", stderr.recv().unwrap_or_default());
    };
    let status = child.wait().unwrap();
    Finished { code: status.code(), stdout, stderr: stderr.recv_timeout(PATIENCE).unwrap_or_default() }
}

/// A program's stderr so far, and a signal for each new line.
#[derive(Default)]
struct Stderr {
    text: Mutex<String>,
    grew: Condvar,
}

/// The resources that a process holds at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Usage {
    /// Resident memory, KiB.
    pub memory_kib: u64,
    /// Number of threads.
    pub threads: usize,
    /// Number of open file descriptors.
    pub files: usize,
}

/// A program that runs with `--events json`. Dropping it kills it.
pub struct Running {
    child: Child,
    events: Receiver<String>,
    seen: Vec<String>,
    stderr: Arc<Stderr>,
    stderr_ends: Option<JoinHandle<()>>,
}

impl Running {
    /// Starts a command, which must print events.
    pub fn start(command: &mut Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (sender, events) = channel();
        forward(child.stdout.take().unwrap(), sender);
        let (sender, lines) = channel();
        forward(child.stderr.take().unwrap(), sender);
        let stderr = Arc::<Stderr>::default();
        let log = stderr.clone();
        let ends = std::thread::spawn(move || {
            for line in lines {
                *log.text.lock().unwrap() += &(line + "\n");
                log.grew.notify_all();
            }
        });
        Self { child, events, seen: Vec::new(), stderr, stderr_ends: Some(ends) }
    }

    /// The next event, of any kind.
    #[track_caller]
    pub fn next(&mut self, what: &str, deadline: Instant) -> Value {
        let left = deadline.saturating_duration_since(Instant::now());
        match self.events.recv_timeout(left) {
            Ok(line) => {
                self.seen.push(line.clone());
                serde_json::from_str(&line).unwrap_or_else(|error| panic!("`{line}` is no JSON: {error}"))
            }
            Err(RecvTimeoutError::Timeout) => panic!("waited in vain for {what}. {}", self.story()),
            Err(RecvTimeoutError::Disconnected) => panic!("the program ended before {what}. {}", self.story()),
        }
    }

    /// Writes a line to the program's standard input.
    #[track_caller]
    pub fn say(&mut self, line: &str) {
        writeln!(self.child.stdin.as_mut().expect("a program with a standard input"), "{line}").unwrap();
    }

    /// Ends the program's standard input.
    pub fn end_input(&mut self) {
        drop(self.child.stdin.take());
    }

    /// Gives a command on standard input and waits for its answer. `command` is an object without `id`.
    #[track_caller]
    pub fn ask(&mut self, mut command: Value) -> Value {
        let id = json!(self.seen.len());
        command["id"] = id.clone();
        self.say(&command.to_string());
        let is_answer = |event: &Value| event["id"] == id && event["event"] != "progress";
        self.until(&format!("the answer to {command}"), is_answer)
    }

    /// The result of a command that must succeed.
    #[track_caller]
    pub fn done(&mut self, command: Value) -> Value {
        let answer = self.ask(command.clone());
        assert_eq!(answer["event"], "done", "{command}: {answer}");
        answer["result"].clone()
    }

    /// The message about a command that must fail.
    #[track_caller]
    pub fn refused(&mut self, command: Value) -> String {
        let answer = self.ask(command.clone());
        assert_eq!(answer["event"], "error", "{command}: {answer}");
        answer["message"].as_str().unwrap().to_owned()
    }

    /// Waits for the first event that `is` accepts.
    #[track_caller]
    pub fn until(&mut self, what: &str, mut is: impl FnMut(&Value) -> bool) -> Value {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let event = self.next(what, deadline);
            if is(&event) {
                return event;
            }
        }
    }

    /// Waits for an event of a kind.
    #[track_caller]
    pub fn event(&mut self, kind: &str) -> Value {
        self.until(kind, |event| event["event"] == kind)
    }

    /// Fails if an event of a kind, or the end of the program, comes within this time.
    #[track_caller]
    pub fn never(&mut self, kind: &str, within: Duration) {
        let deadline = Instant::now() + within;
        loop {
            match self.events.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(line) => {
                    let event: Value = serde_json::from_str(&line).unwrap();
                    self.seen.push(line);
                    assert_ne!(event["event"], kind, "{}", self.story());
                }
                Err(RecvTimeoutError::Timeout) => return,
                Err(RecvTimeoutError::Disconnected) => panic!("the program ended. {}", self.story()),
            }
        }
    }

    /// Waits for a reload that ended well or did not.
    #[track_caller]
    pub fn reload(&mut self, ok: bool) -> Value {
        self.until(&format!("a reload with ok={ok}"), |event| event["event"] == "reload" && event["ok"] == ok)
    }

    /// Waits until a window shows a reload with all of its stages and light.
    #[track_caller]
    pub fn settled(&mut self, reload: &Value) {
        let generation = &reload["generation"];
        self.until("settled", |event| event["event"] == "settled" && event["generation"] == *generation);
    }

    /// Waits for the end of the program.
    #[track_caller]
    pub fn end(&mut self) -> ExitStatus {
        let deadline = Instant::now() + PATIENCE;
        // Its output closes with it.
        loop {
            match self.events.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(line) => self.seen.push(line),
                Err(RecvTimeoutError::Timeout) => panic!("the program did not end. {}", self.story()),
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        let status = self.child.wait().unwrap();
        if let Some(thread) = self.stderr_ends.take() {
            thread.join().unwrap();
        }
        status
    }

    /// Sends a signal, named without SIG.
    #[track_caller]
    pub fn signal(&self, name: &str) {
        send_signal(self.child.id(), name);
    }

    /// The process that does the work: a window's is the child of the program's (proc(5)).
    pub fn worker(&self) -> u32 {
        let id = self.child.id();
        let children = std::fs::read_to_string(format!("/proc/{id}/task/{id}/children")).unwrap();
        children.split_whitespace().next().map_or(id, |child| child.parse().unwrap())
    }

    /// Processor time that the program took so far, all threads, in ticks of 10 ms (proc(5)).
    pub fn ticks(&self) -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.worker())).unwrap();
        // The name, in parentheses, may hold anything; user and system time are fields 14 and 15.
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
        fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap()
    }

    /// The resources that the program holds now (proc(5)).
    pub fn usage(&self) -> Usage {
        let process = format!("/proc/{}", self.worker());
        let count = |folder: &str| std::fs::read_dir(format!("{process}/{folder}")).unwrap().count();
        Usage {
            memory_kib: held_kib(&std::fs::read_to_string(format!("{process}/smaps")).unwrap()),
            threads: count("task"),
            files: count("fd"),
        }
    }

    /// The program's stderr so far; all of it after [`Self::end`].
    pub fn stderr(&self) -> String {
        self.stderr.text.lock().unwrap().clone()
    }

    /// Waits until the program has said `part` on stderr.
    #[track_caller]
    pub fn until_stderr(&self, part: &str) {
        let text = self.stderr.text.lock().unwrap();
        let (text, waited) = self.stderr.grew.wait_timeout_while(text, PATIENCE, |text| !text.contains(part)).unwrap();
        drop(text);
        assert!(!waited.timed_out(), "waited in vain for `{part}` on stderr. {}", self.story());
    }

    /// The program's output so far, for messages.
    pub fn story(&self) -> String {
        format!("Events so far:\n{}\nstderr so far:\n{}", self.seen.join("\n"), self.stderr())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn forward(pipe: impl Read + Send + 'static, to: Sender<String>) {
    std::thread::spawn(move || {
        for line in BufReader::new(pipe).lines().map_while(Result::ok) {
            if to.send(line).is_err() {
                return;
            }
        }
    });
}

/// KiB that the mappings of a process hold: their resident pages, but blocks of device memory as a whole. The software device takes such a
/// block of 64 MiB from the heap, and a page of it becomes resident when an allocation first lies there. So the resident part of a block
/// grows with the places of what is allocated, although no more is. The mappings of glibc's arenas are smaller.
fn held_kib(smaps: &str) -> u64 {
    const LEAST_BLOCK: u64 = 64 * 1024;
    let number = |text: &str| text.trim().trim_end_matches(" kB").parse::<u64>().unwrap();
    let (mut held, mut is_anonymous, mut size) = (0, false, 0);
    for line in smaps.lines() {
        if let Some(text) = line.strip_prefix("Size:") {
            size = number(text);
        } else if let Some(text) = line.strip_prefix("Rss:") {
            held += if is_anonymous && size >= LEAST_BLOCK { size } else { number(text) };
        } else if line.split_whitespace().next().is_some_and(|first| !first.ends_with(':')) {
            is_anonymous = line.contains(" rw-p ") && line.split_whitespace().count() == 5;
        }
    }
    held
}

/// Sends a signal, named without SIG, to a process.
#[track_caller]
pub fn send_signal(process: u32, name: &str) {
    let status = Command::new("kill").args(["-s", name, &process.to_string()]).status().unwrap();
    assert!(status.success(), "kill -s {name} {process}: {status}");
}
