"""Exceptions. All are :class:`SpeculaError`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, List, Mapping, Optional, Sequence, Tuple, cast

__all__ = ["CommandError", "CrashError", "Diagnostic", "ProcessError", "ProgramNotFound", "ShaderError", "SpeculaError"]


class SpeculaError(Exception):
    """Anything that Specula reports."""


class ProgramNotFound(SpeculaError):
    """There is no program ``specula``."""


class ProcessError(SpeculaError):
    """The program could not start, or it ended: the session is over.

    ``code`` is its exit code, negative for a signal, ``None`` for a window that was joined. ``stderr`` has its last lines.
    """

    def __init__(self, message: str, code: Optional[int] = None, stderr: str = "") -> None:
        super().__init__(message, code, stderr)
        self.message = message
        self.code = code
        self.stderr = stderr

    def __str__(self) -> str:
        return f"{self.message}\n{self.stderr}".rstrip()


class CommandError(SpeculaError):
    """The program refused a command; the session goes on. ``answer`` is the whole answer."""

    def __init__(self, message: str, command: str = "", answer: Optional[Mapping[str, Any]] = None) -> None:
        super().__init__(message, command, answer)
        self.message = message
        self.command = command
        self.answer: Mapping[str, Any] = {} if answer is None else answer

    def __str__(self) -> str:
        return self.message


class CrashError(CommandError):
    """The program crashed, or lost its device, before it had answered. It has started again with its settings and the last good shaders, so the
    session goes on. ``stderr`` has the last lines that it has printed.
    """

    def __init__(self, message: str, command: str = "", stderr: str = "") -> None:
        super().__init__(message, command)
        self.stderr = stderr

    def __reduce__(self) -> Tuple[Any, ...]:
        return (CrashError, (self.message, self.command, self.stderr))

    def __str__(self) -> str:
        return f"{self.message}; `{self.command}` was not answered, and the session goes on\n{self.stderr}".rstrip()


@dataclass(frozen=True)
class Diagnostic:
    """One message of the compiler. ``str()`` shows the line and its caret."""

    severity: str
    """``"error"`` or ``"warning"``."""
    file: str
    """The file of the tree, such as ``brdf/ndf.glsl``."""
    line: Optional[int]
    """From 1; ``None`` for the whole file."""
    column: Optional[int]
    """From 1, in characters; ``None`` for the whole line."""
    length: int
    """Characters under the caret."""
    message: str
    excerpt: Optional[str]
    """The line as it is written."""
    help: Optional[str]
    """What to do."""
    notes: Tuple[str, ...]

    @classmethod
    def of(cls, fields: Mapping[str, Any]) -> "Diagnostic":
        """The diagnostic that an event or an answer describes."""
        notes = cast("Sequence[Any]", fields.get("notes") or ())
        return cls(
            severity=str(fields.get("severity", "error")),
            file=str(fields.get("file", "")),
            line=fields.get("line"),
            column=fields.get("column"),
            length=int(fields.get("length") or 0),
            message=str(fields.get("message", "")),
            excerpt=fields.get("excerpt"),
            help=fields.get("help"),
            notes=tuple(str(note) for note in notes),
        )

    def __str__(self) -> str:
        place = self.file
        if self.line is not None:
            place += f":{self.line}" if self.column is None else f":{self.line}:{self.column}"
        lines = [f"{place}: {self.severity}: {self.message}"]
        if self.excerpt is not None:
            number = "" if self.line is None else str(self.line)
            # A tab is one character of the line, and one of the caret's indentation.
            lines.append(f"{number:>5} | {self.excerpt.expandtabs(1)}")
            if self.column is not None:
                lines.append("      | " + " " * (self.column - 1) + "^" * max(self.length, 1))
        if self.help:
            lines.append(f"      = help: {self.help}")
        lines.extend(f"      = {note}" for note in self.notes)
        return "\n".join(lines)


class ShaderError(CommandError):
    """The shaders do not compile, or a check failed. The picture and the last good shaders stay.

    ``diagnostics`` has all messages; ``str()`` shows them with the line and the caret.
    """

    def __init__(self, diagnostics: Sequence[Diagnostic], command: str = "", answer: Optional[Mapping[str, Any]] = None) -> None:
        message = "\n".join(str(diagnostic) for diagnostic in diagnostics)
        super().__init__(message, command, answer)
        self.diagnostics: List[Diagnostic] = list(diagnostics)

    def __reduce__(self) -> Tuple[Any, ...]:
        return (ShaderError, (self.diagnostics, self.command, self.answer))
