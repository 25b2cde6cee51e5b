"""Where the program is."""

from __future__ import annotations

import os
import shutil
from importlib import metadata
from pathlib import Path
from typing import Optional, Union

from ._errors import ProgramNotFound

__all__ = ["find_program"]

_NAME = "specula.exe" if os.name == "nt" else "specula"


def find_program(program: Union[None, str, "os.PathLike[str]"] = None) -> str:
    """The path of the program: ``program``, the variable ``SPECULA``, the one of the wheel, or the one on ``PATH``.

    Raises :class:`ProgramNotFound` if there is none.
    """
    given = os.fspath(program) if program is not None else os.environ.get("SPECULA")
    if given:
        found = shutil.which(given)
        if found is None:
            source = "program" if program is not None else "the variable SPECULA"
            raise ProgramNotFound(f"{given} ({source}) is no program")
        return found
    found = _of_wheel() or shutil.which(_NAME)
    if found is None:
        raise ProgramNotFound("there is no program `specula`: install its package, or set the variable SPECULA to its path")
    return found


def _of_wheel() -> Optional[str]:
    """The program that pip has installed with this package."""
    try:
        files = metadata.files("specula") or []
    except metadata.PackageNotFoundError:
        return None
    for file in files:
        if file.name == _NAME and file.parent.name in ("bin", "Scripts"):
            path = Path(str(file.locate())).resolve()
            if os.access(path, os.X_OK):
                return str(path)
    return None
