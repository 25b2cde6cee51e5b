"""A folder for files that live as long as a session, in memory where the system has a file system for that."""

from __future__ import annotations

import contextlib
import itertools
import os
import shutil
import stat
import tempfile
import threading
from pathlib import Path
from typing import List, Optional

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

__all__ = ["Scratch"]

_PREFIX = "specula-py-"
_LOCK = "lock"


def _root() -> Path:
    memory = Path("/dev/shm")
    return memory if memory.is_dir() and os.access(memory, os.W_OK) else Path(tempfile.gettempdir())


class Scratch:
    """A folder of a session, made when it is needed. Its lock tells other sessions that the owner lives."""

    def __init__(self) -> None:
        self._folder: Optional[Path] = None
        self._lock: Optional[int] = None
        self._mutex = threading.Lock()
        self._owner = os.getpid()
        self._numbers = itertools.count(1)

    def path(self, ending: str) -> Path:
        """A new path in the folder."""
        return self._make() / f"{next(self._numbers)}{ending}"

    def _make(self) -> Path:
        with self._mutex:
            if self._folder is None:
                root = _root()
                for folder in _left_behind(root):
                    shutil.rmtree(folder, ignore_errors=True)
                folder = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=str(root)))
                # Locked before it has its name: no other session sees it without its lock.
                self._lock = os.open(str(folder / "new"), os.O_CREAT | os.O_RDWR, 0o600)
                if fcntl is not None:
                    fcntl.flock(self._lock, fcntl.LOCK_EX)
                os.rename(str(folder / "new"), str(folder / _LOCK))
                self._folder = folder
            return self._folder

    def remove(self) -> None:
        """Removes the folder with all that is in it. A fork of the process leaves it."""
        if os.getpid() != self._owner:
            return
        with self._mutex:
            folder, self._folder = self._folder, None
            if folder is not None:
                shutil.rmtree(folder, ignore_errors=True)
            self.forget()

    def forget(self) -> None:
        """Gives up the lock alone, for a fork of the process."""
        lock, self._lock = self._lock, None
        if lock is not None:
            with contextlib.suppress(OSError):
                os.close(lock)


def _left_behind(root: Path) -> List[Path]:
    """Folders of sessions whose process was killed."""
    found: List[Path] = []
    if fcntl is None:
        return found
    with contextlib.suppress(OSError):
        for folder in root.glob(_PREFIX + "*"):
            with contextlib.suppress(OSError):
                state = folder.lstat()
                if not stat.S_ISDIR(state.st_mode) or state.st_uid != os.getuid():
                    continue
                # A folder without a lock is just being made.
                lock = os.open(str(folder / _LOCK), os.O_RDWR)
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    found.append(folder)
                finally:
                    os.close(lock)
    return found
