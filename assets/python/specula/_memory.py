"""Files in memory that have no name: the program writes pictures to them, and they end with the processes that have them open."""

from __future__ import annotations

import contextlib
import os
import queue
from typing import TYPE_CHECKING, Any, List, Optional

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["Memory"]

_FILES = 8


class Memory:
    """Some files in memory. The program must be started with all of them."""

    def __init__(self, count: int = _FILES) -> None:
        self.files: List[int] = []
        """Their numbers, here and in the program."""
        self._free: "queue.SimpleQueue[int]" = queue.SimpleQueue()
        # Linux alone has them.
        if hasattr(os, "memfd_create"):
            for _ in range(count):
                self.files.append(os.memfd_create("specula"))
                self._free.put(self.files[-1])

    def take(self) -> Optional[int]:
        """A file for one picture; `None` while none is free."""
        with contextlib.suppress(queue.Empty):
            return self._free.get_nowait()
        return None

    def give_back(self, number: int) -> None:
        """Gives a file back for another picture."""
        self._free.put(number)

    def read(self, number: int) -> "npt.NDArray[Any]":
        """The array that the program has written."""
        with open(number, "rb", closefd=False) as file:
            file.seek(0)
            return np.load(file, allow_pickle=False)

    def close(self) -> None:
        """Closes all files."""
        for number in self.files:
            with contextlib.suppress(OSError):
                os.close(number)
        self.files = []
