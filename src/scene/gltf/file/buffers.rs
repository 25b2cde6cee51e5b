//! Reads buffers and the files that contain them.

use std::borrow::Cow;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gltf::json;

use super::archive::inside;
use super::opened::Place;
use super::uri::{self, UriTarget};
use crate::regular_file;
use crate::scene::error::Problem;
use crate::scene::gltf::left_out::{LeftOut, Part};
use crate::scene::gltf::memory::Memory;
use crate::scene::gltf::place::{out_of_range, place};
use crate::scene::load_options::Canceled;

/// Where the model's files are, and which the loader has looked for.
pub struct Files<'t> {
    place: Place,
    /// `--allow-outside`.
    allow_outside: bool,
    /// Whether the load is no longer needed.
    pub canceled: Canceled<'t>,
    /// Memory for the model's parts. A file counts as often as the model names it.
    pub memory: Memory,
    /// Every file read or looked for so far, absolute.
    pub tried: &'t mut Vec<PathBuf>,
    /// The same files, for a model that names many.
    known: HashSet<PathBuf>,
}

impl<'t> Files<'t> {
    /// The files of a model whose own file, or the archive that it is in, has `stored` bytes.
    pub fn new(
        (place, stored): (Place, u64),
        allow_outside: bool,
        canceled: Canceled<'t>,
        tried: &'t mut Vec<PathBuf>,
    ) -> Self {
        let known = tried.iter().cloned().collect();
        Self { place, allow_outside, canceled, memory: Memory::new(stored), tried, known }
    }

    /// Loads the bytes of a URI. `user` is for messages.
    pub fn load(&mut self, uri: &str, user: &str) -> Result<Vec<u8>, Problem> {
        // Whatever a path in an archive says, it does not leave the archive.
        let stays_inside = matches!(self.place, Place::Archive(..));
        let names = match uri::parse(uri, user, self.allow_outside || stays_inside)? {
            UriTarget::Data(bytes) => return Ok(bytes),
            UriTarget::File(names) => names,
        };
        if (self.canceled)() {
            return Err(Problem::Canceled);
        }
        match self.place.clone() {
            Place::Nowhere => {
                let found = format!("the external file `{}`", names[0].display());
                Err(Problem::invalid(user, "all data inside of a built-in model", found))
            }
            Place::Archive(archive, folder) => {
                let inside = |name: &PathBuf| inside(format!("{folder}/{}", name.to_str()?).trim_start_matches('/'));
                let named: Vec<String> = names.iter().filter_map(inside).collect();
                let Some(first) = named.first() else {
                    let (uri, found) = (names[0].display().to_string(), "a path that leaves the archive".to_owned());
                    return Err(Problem::Outside { place: user.into(), uri, found });
                };
                let name = named.iter().find(|name| archive.has(name)).unwrap_or(first);
                let path = PathBuf::from(name);
                self.memory.take(Some(archive.size(name)), user)?;
                archive.read(name).map_err(|source| Problem::External { place: user.into(), path, source })
            }
            Place::Folder(folder) => self.load_from(&folder, &names, user),
        }
    }

    /// Reads the first of these files that exists.
    fn load_from(&mut self, folder: &Path, names: &[PathBuf], user: &str) -> Result<Vec<u8>, Problem> {
        let (mut named, mut is_new) = (&names[0], false);
        for name in names {
            let path = folder.join(name);
            let exists = path.exists();
            is_new = self.known.insert(path.clone());
            if is_new {
                self.tried.push(path);
            }
            if exists {
                named = name;
                break;
            }
        }
        let path = folder.join(named);
        // The text of a path does not show where its links lead.
        match linked_outside(folder, &path) {
            Ok(Some(end)) if !self.allow_outside => {
                let found = format!("a link to {}", end.display());
                Err(Problem::Outside { place: user.into(), uri: named.display().to_string(), found })
            }
            found => {
                let external = |source| Problem::External { place: user.into(), path: path.clone(), source };
                found.map_err(external)?;
                let size = path.metadata().map_or(0, |metadata| metadata.len());
                if is_new {
                    self.memory.add_stored(size);
                }
                self.memory.take(Some(size), user)?;
                regular_file::read(&path, regular_file::LARGEST).map_err(external)
            }
        }
    }
}

/// The real location of `path`, if links lead it out of `folder`.
fn linked_outside(folder: &Path, path: &Path) -> std::io::Result<Option<PathBuf>> {
    let end = path.canonicalize()?;
    Ok(if end.starts_with(folder.canonicalize()?) { None } else { Some(end) })
}

/// The contents of all buffers. A buffer that cannot be read is a problem of those parts of the model that lie in it.
pub struct Buffers<'a>(Vec<Buffer<'a>>);

/// The bytes of a buffer, and why some or all of them are missing.
struct Buffer<'a> {
    bytes: Cow<'a, [u8]>,
    problem: Option<Arc<Problem>>,
}

impl<'a> Buffer<'a> {
    fn new(bytes: Result<Cow<'a, [u8]>, Problem>) -> Self {
        match bytes {
            Ok(bytes) => Self { bytes, problem: None },
            Err(problem) => Self { bytes: Cow::Borrowed(&[]), problem: Some(problem.into()) },
        }
    }
}

impl<'a> Buffers<'a> {
    /// Reads all buffers of a file; `bin` is the GLB's binary chunk.
    ///
    /// # Errors
    /// The load was canceled.
    pub fn load(
        root: &json::Root,
        bin: Option<&'a [u8]>,
        files: &mut Files<'_>,
        left_out: &mut LeftOut,
    ) -> Result<Self, Problem> {
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (index, buffer) in root.buffers.iter().enumerate() {
            let place = place("buffers", index, buffer.name.as_deref());
            let bytes = match (&buffer.uri, bin) {
                (Some(uri), _) => files.load(uri, &place).map(Cow::Owned),
                (None, Some(bin)) if index == 0 => Ok(Cow::Borrowed(bin)),
                (None, _) => Err(Problem::invalid(&place, "a uri, or to be the binary chunk of a GLB", "neither")),
            };
            if (files.canceled)() {
                return Err(Problem::Canceled);
            }
            let (claimed, mut bytes) = (buffer.byte_length.0, Buffer::new(bytes));
            if bytes.problem.is_none() && (bytes.bytes.len() as u64) < claimed {
                let found = format!("{} bytes", bytes.bytes.len());
                let short = Arc::new(Problem::invalid(&place, format!("{claimed} bytes (byteLength)"), found));
                left_out.add(Part::END, &place, Problem::Unreadable(short.clone()));
                bytes.problem = Some(short);
            }
            buffers.push(bytes);
        }
        Ok(Self(buffers))
    }

    /// The bytes of a buffer view.
    pub fn view(&self, root: &json::Root, view: json::Index<json::buffer::View>, user: &str) -> Result<&[u8], Problem> {
        let index = view.value();
        let Some(view) = root.buffer_views.get(index) else {
            return Err(out_of_range(user, "bufferViews", index, root.buffer_views.len()));
        };
        let place = place("bufferViews", index, view.name.as_deref());
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        self.range(root, view.buffer.value(), start, view.byte_length.0, &place)
    }

    /// `length` bytes of a buffer, from byte `start`.
    pub fn range(
        &self,
        root: &json::Root,
        buffer_index: usize,
        start: u64,
        length: u64,
        place: &str,
    ) -> Result<&[u8], Problem> {
        let Some(buffer) = self.0.get(buffer_index) else {
            return Err(out_of_range(place, "buffers", buffer_index, self.0.len()));
        };
        let Buffer { bytes, problem } = buffer;
        let missing = problem.as_ref().map(|problem| Problem::Unreadable(problem.clone()));
        // `byteLength` is the limit. Data beyond it is padding.
        let limit = root.buffers[buffer_index].byte_length.0.min(bytes.len() as u64);
        let end = start.checked_add(length).filter(|&end| end <= limit);
        let range = end.and_then(|end| Some(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        match (range.and_then(|range| bytes.get(range)), missing) {
            (Some(found), None) => Ok(found),
            (Some(found), Some(_)) if !bytes.is_empty() => Ok(found),
            (_, Some(missing)) => Err(missing),
            (None, None) => {
                let expected = format!("a range inside of the {limit} bytes of buffers[{buffer_index}]");
                Err(Problem::invalid(place, expected, format!("byteOffset {start} and byteLength {length}")))
            }
        }
    }

    /// Adds a buffer, or the reason for which it cannot be read.
    pub fn push(&mut self, bytes: Result<Vec<u8>, Problem>) {
        self.0.push(Buffer::new(bytes.map(Cow::Owned)));
    }
}
