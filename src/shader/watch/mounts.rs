//! Finds file systems that other machines write to. The kernel does not notify about their changes.

use std::path::{Path, PathBuf};

/// File system types of network mounts and of folders shared with a virtual machine, as `/proc/self/mountinfo` names them.
const SHARED: [&str; 16] = [
    "9p", "afs", "beegfs", "ceph", "cifs", "fuse", "gfs2", "gpfs", "lustre", "nfs", "nfs4", "prl_fs", "smb3", "smbfs",
    "vboxsf", "virtiofs",
];

/// The mount points of this process, and the file system type of each.
#[derive(Debug, Default)]
pub struct Mounts(Vec<(PathBuf, String)>);

impl Mounts {
    /// Reads the mount points; none on systems without procfs.
    pub fn read() -> Self {
        Self::parse(&std::fs::read_to_string("/proc/self/mountinfo").unwrap_or_default())
    }

    /// Reads the format of proc(5): `ID PARENT MAJOR:MINOR ROOT MOUNT-POINT OPTIONS [TAGS...] - TYPE SOURCE OPTIONS`.
    fn parse(text: &str) -> Self {
        let mount = |line: &str| {
            let (before, after) = line.split_once(" - ")?;
            let point = before.split(' ').nth(4)?;
            Some((unescape(point), after.split(' ').next()?.to_owned()))
        };
        Self(text.lines().filter_map(mount).collect())
    }

    /// The type of the file system that holds `directory`, if other machines may write to that file system.
    /// `directory` is absolute and has no symbolic links.
    pub fn shared(&self, directory: &Path) -> Option<&str> {
        let above = self.0.iter().filter(|(point, _)| directory.starts_with(point));
        // Of several mounts on one point, the last one is visible.
        let (_, kind) = above.max_by_key(|(point, _)| point.components().count())?;
        let is_shared = SHARED.contains(&kind.as_str()) || kind.starts_with("fuse.");
        is_shared.then_some(kind.as_str())
    }
}

/// Replaces the octal escapes of spaces, tabs, newlines and backslashes.
fn unescape(point: &str) -> PathBuf {
    let escapes = [("\\040", " "), ("\\011", "\t"), ("\\012", "\n"), ("\\134", "\\")];
    escapes.iter().fold(point.to_owned(), |text, (escape, is)| text.replace(escape, is)).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innermost_mount_decides() {
        let mounts = Mounts::parse(
            "22 1 254:0 / / rw - ext4 /dev/vda rw\n\
             30 22 0:44 / /mnt/my\\040share rw,relatime shared:1 master:2 - nfs4 host:/export rw\n\
             31 30 0:45 / /mnt/my\\040share/local rw - tmpfs tmpfs rw\n\
             32 22 0:46 / /home/me/far rw - fuse.sshfs me@host: rw\n\
             33 22 0:47 / /media/disk rw - fuseblk /dev/sdb1 rw\n\
             34 22 0:48 / /over rw - nfs host:/a rw\n\
             35 34 0:49 / /over rw - tmpfs tmpfs rw\n\
             a line that is cut",
        );
        let shared = |path: &str| mounts.shared(Path::new(path)).map(str::to_owned);
        assert_eq!(shared("/mnt/my share/shaders").as_deref(), Some("nfs4"));
        assert_eq!(shared("/home/me/far").as_deref(), Some("fuse.sshfs"));
        for local in ["/", "/mnt/my", "/mnt/my share/local/x", "/media/disk", "/over/x", "/home/me/farther"] {
            assert_eq!(shared(local), None, "{local}");
        }
    }
}
