//! The local socket: a file that only the user can reach. There is no network port.

#[cfg(unix)]
use std::collections::VecDeque;
use std::io;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::sync::atomic::{AtomicUsize, Ordering};
#[cfg(unix)]
use std::sync::{Arc, Mutex, PoisonError};

use crossbeam_channel::Sender;

use super::{Asked, Clients};
use crate::message::warn;

/// A socket that accepts clients. Its file is removed with it.
pub struct Socket {
    path: PathBuf,
    #[cfg(unix)]
    listener: std::os::unix::net::UnixListener,
    /// Identifies the file that this socket has created.
    #[cfg(unix)]
    file: FileId,
}

/// The device and the inode of a file.
#[cfg(unix)]
type FileId = (u64, u64);

#[cfg(unix)]
fn file_id(path: &Path) -> io::Result<FileId> {
    use std::os::unix::fs::MetadataExt as _;
    std::fs::symlink_metadata(path).map(|file| (file.dev(), file.ino()))
}

/// The files of this process's sockets, for a signal that ends it.
#[cfg(unix)]
static BOUND: Mutex<Vec<(PathBuf, FileId)>> = Mutex::new(Vec::new());

/// Removes the files of all sockets of this process, which is about to end.
pub fn remove_sockets() {
    #[cfg(unix)]
    for (path, file) in std::mem::take(&mut *BOUND.lock().unwrap_or_else(PoisonError::into_inner)) {
        remove_own(&path, file);
    }
}

/// Removes the file of a socket that is still open, so that no other file has its number. If somebody has removed the file, another may be
/// at the path by now, and stays.
#[cfg(unix)]
fn remove_own(path: &Path, file: FileId) {
    let _lock = path.parent().map(lock_folder);
    if file_id(path).is_ok_and(|there| there == file) {
        let _ = std::fs::remove_file(path);
    }
}

/// Locks a folder until the returned file is dropped, so that no other window replaces or removes a socket in it meanwhile.
#[cfg(unix)]
fn lock_folder(folder: &Path) -> io::Result<std::fs::File> {
    let folder = std::fs::File::open(folder)?;
    folder.lock()?;
    Ok(folder)
}

/// The path of the socket `name`: a path, or a name without a slash, which lies in the user's folder for sockets.
///
/// # Errors
/// There is no such folder.
pub fn socket_path(name: &Path) -> Result<PathBuf, String> {
    let is_name = name.components().count() == 1 && !name.as_os_str().as_encoded_bytes().contains(&b'/');
    if !is_name {
        return std::path::absolute(name).map_err(|error| format!("{}: {error}", name.display()));
    }
    let folder = std::env::var_os("XDG_RUNTIME_DIR").filter(|folder| !folder.is_empty()).ok_or_else(|| {
        format!("--socket {0}: XDG_RUNTIME_DIR is not set; give a path, as --socket ~/.specula/{0}", name.display())
    })?;
    let mut file = name.as_os_str().to_owned();
    if name.extension().is_none() {
        file.push(".sock");
    }
    Ok(PathBuf::from(folder).join("specula").join(file))
}

#[cfg(unix)]
impl Socket {
    /// Creates the socket's file with mode 0600. The folder must be accessible to the user only. A file that an earlier process
    /// has left is replaced.
    ///
    /// # Errors
    /// The folder is not there or open to others, another process listens, or another file has the name.
    pub fn bind(path: PathBuf) -> Result<Self, String> {
        use std::os::unix::fs::{DirBuilderExt as _, FileTypeExt as _, PermissionsExt as _};
        use std::os::unix::net::{UnixListener, UnixStream};
        let cannot = |why: String| format!("cannot listen on {}: {why}", path.display());
        let folder = path.parent().unwrap_or(Path::new("/"));
        let is_ours =
            std::env::var_os("XDG_RUNTIME_DIR").is_some_and(|runtime| folder == Path::new(&runtime).join("specula"));
        if is_ours && !folder.exists() {
            let made = std::fs::DirBuilder::new().mode(0o700).create(folder);
            made.or_else(|error| if folder.is_dir() { Ok(()) } else { Err(error) })
                .map_err(|e| cannot(e.to_string()))?;
        }
        let mode = std::fs::metadata(folder).map_err(|e| cannot(format!("{}: {e}", folder.display())))?;
        let mode = mode.permissions().mode() & 0o777;
        if mode & 0o077 != 0 {
            let folder = folder.display();
            return Err(cannot(format!(
                "others can enter the folder {folder} (mode {mode:03o}). `chmod 700 {folder}`, or give a name without a slash, which \
                 lies in $XDG_RUNTIME_DIR/specula"
            )));
        }
        let _lock = lock_folder(folder).map_err(|e| cannot(e.to_string()))?;
        if let Ok(there) = std::fs::symlink_metadata(&path) {
            if !there.file_type().is_socket() {
                return Err(cannot("there is another file of this name".to_owned()));
            }
            if UnixStream::connect(&path).is_ok() {
                return Err(cannot("another window listens there; give this one another name".to_owned()));
            }
            std::fs::remove_file(&path).map_err(|e| cannot(e.to_string()))?;
        }
        // Nobody else can enter the folder, so nobody connects before the mode is set.
        let listener = UnixListener::bind(&path).map_err(|e| cannot(e.to_string()))?;
        let set = std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o600));
        set.map_err(|e| cannot(e.to_string()))?;
        let file = file_id(&path).map_err(|e| cannot(e.to_string()))?;
        BOUND.lock().unwrap_or_else(PoisonError::into_inner).push((path.clone(), file));
        Ok(Self { path, listener, file })
    }

    /// Accepts clients on a thread. Each gets the events, and has a thread that reads its commands.
    pub(super) fn accept(&self, clients: Clients, sender: Sender<Asked>) {
        let Ok(listener) = self.listener.try_clone() else { return };
        let connected = Arc::<Connected>::default();
        let work = move || {
            for stream in listener.incoming() {
                match stream.and_then(|stream| connect(stream, &clients, &connected, &sender)) {
                    Ok(()) => {}
                    Err(error) => {
                        tracing::debug!("a client of the socket was not accepted: {error}");
                        // For example, too many open files, which may last a while.
                        std::thread::sleep(std::time::Duration::from_millis(100));
                    }
                }
            }
        };
        if let Err(error) = std::thread::Builder::new().name("specula-socket".to_owned()).spawn(work) {
            warn(format_args!("nobody can connect to {}: {error}", self.path.display()));
        }
    }
}

/// Most clients that may send commands at a time. Each has two threads.
#[cfg(unix)]
const MOST_CLIENTS: usize = 64;
/// Most clients that stay connected after the end of their commands.
#[cfg(unix)]
const MOST_ENDED: usize = 16;

/// The clients of a socket.
#[cfg(unix)]
#[derive(Default)]
struct Connected {
    /// Number of those that may send commands.
    sending: AtomicUsize,
    /// Those that have ended their commands, the oldest first.
    ended: Mutex<VecDeque<super::Client>>,
}

#[cfg(unix)]
fn connect(
    mut stream: std::os::unix::net::UnixStream,
    clients: &Clients,
    connected: &Arc<Connected>,
    sender: &Sender<Asked>,
) -> io::Result<()> {
    use super::{Client, reader};
    if connected.sending.load(Ordering::Relaxed) >= MOST_CLIENTS {
        let message = format!("{MOST_CLIENTS} clients are connected already; connect again when one of them has ended");
        let line = serde_json::json!({ "event": "error", "id": null, "command": "", "message": message });
        return io::Write::write_all(&mut stream, format!("{line}\n").as_bytes());
    }
    let (input, output, line) = (stream.try_clone()?, stream.try_clone()?, stream.try_clone()?);
    let hang_up = move || drop(line.shutdown(std::net::Shutdown::Both));
    let client = Client::start(output, Some(Box::new(hang_up)));
    clients.add(client.clone());
    let sender = sender.clone();
    // A client may end its commands and continue to read events, so the end of its input does not close it. Whether it still
    // reads is known only when a line is written to it, so only the newest of these clients stay open.
    connected.sending.fetch_add(1, Ordering::Relaxed);
    let here = connected.clone();
    let work = move || {
        reader::read(input, &client, &sender);
        here.sending.fetch_sub(1, Ordering::Relaxed);
        let mut ended = here.ended.lock().unwrap_or_else(PoisonError::into_inner);
        ended.push_back(client);
        if ended.len() > MOST_ENDED
            && let Some(oldest) = ended.pop_front()
        {
            oldest.close();
        }
    };
    let started = std::thread::Builder::new().name("specula-commands".to_owned()).spawn(work);
    if started.is_err() {
        connected.sending.fetch_sub(1, Ordering::Relaxed);
    }
    started.map(|_| ())
}

#[cfg(not(unix))]
impl Socket {
    /// Unix sockets only.
    ///
    /// # Errors
    /// Always.
    pub fn bind(path: PathBuf) -> Result<Self, String> {
        Err(format!("cannot listen on {}: this system has no Unix sockets; use --events json", path.display()))
    }

    pub(super) fn accept(&self, _: Clients, _: Sender<Asked>) {}
}

impl Socket {
    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

#[cfg(unix)]
impl Drop for Socket {
    fn drop(&mut self) {
        remove_own(&self.path, self.file);
        BOUND.lock().unwrap_or_else(PoisonError::into_inner).retain(|(_, file)| *file != self.file);
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::PermissionsExt as _;

    use super::*;

    fn private() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o700)).unwrap();
        folder
    }

    #[test]
    fn the_file_is_the_users_alone_and_goes_with_the_socket() {
        let folder = private();
        let path = folder.path().join("s.sock");
        let socket = Socket::bind(path.clone()).unwrap();
        assert_eq!(path.metadata().unwrap().permissions().mode() & 0o777, 0o600);
        let second = Socket::bind(path.clone()).err().unwrap();
        assert!(second.contains("another window listens there"), "{second}");
        drop(socket);
        assert!(!path.exists());
    }

    #[test]
    fn of_many_windows_one_takes_over_the_file_of_an_ended_process() {
        let folder = private();
        let path = folder.path().join("s.sock");
        for _ in 0..40 {
            drop(std::os::unix::net::UnixListener::bind(&path).unwrap());
            let start = std::sync::Barrier::new(4);
            let bind = || {
                start.wait();
                Socket::bind(path.clone()).ok()
            };
            let sockets: Vec<Option<Socket>> = std::thread::scope(|scope| {
                let threads = [(); 4].map(|()| scope.spawn(bind));
                threads.into_iter().map(|thread| thread.join().unwrap()).collect()
            });
            assert_eq!(sockets.iter().flatten().count(), 1);
            std::os::unix::net::UnixStream::connect(&path).expect("the socket of the window that listens");
        }
    }

    #[test]
    fn a_socket_that_another_window_has_bound_since_stays() {
        let folder = private();
        let path = folder.path().join("s.sock");
        let first = Socket::bind(path.clone()).unwrap();
        std::fs::remove_file(&path).unwrap();
        let second = Socket::bind(path.clone()).unwrap();
        drop(first);
        assert!(path.exists(), "the first window removed the socket of the second");
        drop(second);
        assert!(!path.exists());
        let third = Socket::bind(path.clone()).unwrap();
        std::fs::remove_file(&path).unwrap();
        std::fs::write(&path, "precious").unwrap();
        drop(third);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "precious");
    }

    #[test]
    fn one_client_too_many_is_told_so_and_the_others_are_served() {
        use std::io::BufRead as _;
        let folder = private();
        let path = folder.path().join("s.sock");
        let (socket, clients, (sender, asked)) =
            (Socket::bind(path.clone()).unwrap(), Clients::default(), crossbeam_channel::unbounded());
        socket.accept(clients.clone(), sender);
        let connect = || std::os::unix::net::UnixStream::connect(&path).unwrap();
        let line_of = |stream| std::io::BufReader::new(stream).lines().next().unwrap().unwrap();
        let served: Vec<_> = (0..MOST_CLIENTS).map(|_| connect()).collect();
        let line = line_of(connect());
        assert!(line.contains("64 clients are connected already"), "{line}");
        clients.send("event");
        for mut stream in served {
            io::Write::write_all(&mut stream, b"{\"command\": \"modes\"}\n").unwrap();
            assert_eq!(asked.recv().unwrap().command, "modes");
            assert_eq!(line_of(stream), "event");
        }
    }

    #[test]
    fn a_folder_that_others_can_enter_is_refused() {
        let folder = private();
        std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o755)).unwrap();
        let error = Socket::bind(folder.path().join("s.sock")).err().unwrap();
        assert!(error.contains("mode 755") && error.contains("chmod 700"), "{error}");
    }

    #[test]
    fn a_file_of_an_ended_process_is_replaced_and_another_file_is_not() {
        let folder = private();
        let path = folder.path().join("s.sock");
        drop(std::os::unix::net::UnixListener::bind(&path).unwrap());
        drop(Socket::bind(path.clone()).unwrap());
        std::fs::write(&path, "text").unwrap();
        let error = Socket::bind(path).err().unwrap();
        assert!(error.contains("another file"), "{error}");
    }
}
