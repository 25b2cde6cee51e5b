"""The program at the other end: a process of its own, or a window that was joined. Commands and answers are JSON, one object a line.

Three threads serve a channel: one writes lines, one reads them, one reads what the process prints on stderr. So a caller never holds
half a line when Ctrl+C interrupts it, and several threads can wait for their answers at once.
"""

from __future__ import annotations

import collections
import contextlib
import itertools
import json
import os
import queue
import signal
import socket
import subprocess
import threading
import time
import weakref
from typing import IO, Any, Callable, Deque, Dict, List, Optional, Sequence, Union

from ._errors import CommandError, CrashError, Diagnostic, ProcessError, ShaderError

__all__ = ["Answer", "Channel"]

Answer = Dict[str, Any]
_File = Union[IO[bytes], socket.SocketIO]

_PATIENCE_S = 5.0
"""How long the process may take to end by itself."""
_SIGNALS_S = 0.25
"""Seconds between two looks for signals: one that comes just before a wait begins does not end it."""
_STDERR_LINES = 40
_MOST_BYTES = 4 << 20
"""Of a command."""


class _Pending:
    """A command that waits for its answer."""

    def __init__(self, drop: Optional[Callable[[], None]]) -> None:
        self.done = threading.Event()
        self.answer: Union[Answer, ProcessError, None] = None
        self.drop = drop
        self.is_abandoned = False


_channels: "weakref.WeakSet[Channel]" = weakref.WeakSet()


class Channel:
    """A connection to a program."""

    def __init__(self, process: Optional["subprocess.Popen[bytes]"], link: Optional[socket.socket]) -> None:
        self._process = process
        self._link = link
        self._owner = os.getpid()
        self._numbers = itertools.count(1)
        self._pending: Dict[int, _Pending] = {}
        self._lock = threading.Lock()
        self._end: Optional[ProcessError] = None
        self._is_closed = False
        self._lines: "queue.SimpleQueue[Optional[bytes]]" = queue.SimpleQueue()
        self._stderr: Deque[str] = collections.deque(maxlen=_STDERR_LINES)
        self._threads: List[threading.Thread] = []
        _channels.add(self)

    @classmethod
    def start(cls, arguments: Sequence[str], keep: Sequence[int] = ()) -> "Channel":
        """Starts a program. `keep` are open files that it gets, too."""
        try:
            # A session of its own, so that the terminal's Ctrl+C ends a call and not the program. The files are unbuffered: a fork of this
            # process closes them without writing anything.
            process = subprocess.Popen(
                list(arguments),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,
                pass_fds=tuple(keep) if os.name == "posix" else (),
                start_new_session=True,
            )
        except OSError as error:
            raise ProcessError(f"{arguments[0]} could not be started: {error}") from error
        channel = cls(process, None)
        assert process.stdin and process.stdout and process.stderr
        try:
            channel._begin(channel._write, process.stdin)
            channel._begin(channel._read_stderr, process.stderr)
            channel._begin(channel._read, process.stdout)
        except BaseException:
            # Ctrl+C, or a limit of threads. Without its threads, the program would not learn of the end.
            process.kill()
            channel.close()
            raise
        return channel

    @classmethod
    def join(cls, path: str) -> "Channel":
        """Joins the window that listens on a socket."""
        link = socket.socket(socket.AF_UNIX)
        try:
            link.connect(path)
        except OSError as error:
            link.close()
            raise ProcessError(f"no window listens on {path}: {error}. Start one with `specula view --socket NAME`") from error
        channel = cls(None, link)
        channel._begin(channel._write, link.makefile("wb", buffering=0))
        channel._begin(channel._read, link.makefile("rb", buffering=0))
        return channel

    def _begin(self, work: Callable[[_File], None], file: _File) -> None:
        thread = threading.Thread(target=work, args=(file,), name="specula", daemon=True)
        thread.start()
        self._threads.append(thread)

    @property
    def stderr(self) -> str:
        """The last lines that the process has printed on stderr."""
        return "\n".join(list(self._stderr))

    @property
    def pid(self) -> Optional[int]:
        """The process."""
        return self._process.pid if self._process else None

    def ask(self, command: str, fields: Dict[str, Any], drop: Optional[Callable[[], None]] = None) -> Any:
        """Sends a command and waits for its answer, whose result it returns.

        If the caller is interrupted meanwhile, the command is canceled, and `drop` runs once the program has answered.
        """
        number = next(self._numbers)
        pending = _Pending(drop)
        try:
            with self._lock:
                if self._end is not None:
                    raise self._end
                self._pending[number] = pending
            self._send({**fields, "id": number, "command": command})
            while not pending.done.wait(_SIGNALS_S):
                pass
        except ValueError:
            with self._lock:
                self._pending.pop(number, None)
            raise
        except BaseException:
            self._abandon(number, pending)
            raise
        return _result(command, pending.answer)

    def _send(self, line: Dict[str, Any]) -> None:
        # NaN is no JSON.
        text = json.dumps(line, allow_nan=False, ensure_ascii=False).encode("utf-8", "replace")
        if len(text) > _MOST_BYTES:
            # The program would skip it, and answer it without its number.
            raise ValueError(f"`{line['command']}` has {len(text):,} bytes, more than {_MOST_BYTES:,}")
        self._lines.put(text + b"\n")

    def _abandon(self, number: int, pending: _Pending) -> None:
        with self._lock:
            pending.is_abandoned = True
            is_open = number in self._pending and self._end is None
        if is_open:
            self._send({"id": 0, "command": "cancel", "of": number})
        elif pending.drop:
            pending.drop()

    def _write(self, file: _File) -> None:
        with contextlib.suppress(OSError, ValueError):
            while True:
                line = self._lines.get()
                if line is None:
                    break
                rest = memoryview(line)
                while rest:
                    rest = rest[file.write(rest) :]
        with contextlib.suppress(OSError):
            file.close()
        if self._link is not None:
            # The end of the commands is not the end of a window.
            with contextlib.suppress(OSError):
                self._link.shutdown(socket.SHUT_RDWR)

    def _read_stderr(self, file: _File) -> None:
        with contextlib.suppress(OSError, ValueError), open(os.dup(file.fileno()), "rb") as lines:
            for line in lines:
                self._stderr.append(line.decode(errors="replace").rstrip())

    def _read(self, file: _File) -> None:
        with contextlib.suppress(OSError, ValueError), open(os.dup(file.fileno()), "rb") as lines:
            for line in lines:
                with contextlib.suppress(ValueError):
                    self._take(json.loads(line))
        self._on_end()

    def _take(self, event: Answer) -> None:
        kind, number = event.get("event"), event.get("id")
        if kind == "restarted":
            self._on_restart(event)
            return
        if kind not in ("done", "error") or not isinstance(number, int):
            return
        with self._lock:
            pending = self._pending.pop(number, None)
            if pending is None:
                return
            pending.answer = event
            is_abandoned = pending.is_abandoned
        pending.done.set()
        if is_abandoned and pending.drop:
            pending.drop()

    def _on_restart(self, event: Answer) -> None:
        """Answers the commands that the process before has not."""
        # It has printed why, but the lines may still be on their way through the other pipe.
        time.sleep(0.1)
        with self._lock:
            open_commands = [pending for pending in self._pending.values() if not pending.is_abandoned]
            for pending in open_commands:
                # The next process may have got it, and then its answer is still to come.
                pending.is_abandoned = True
                pending.answer = {**event, "stderr": self.stderr}
        for pending in open_commands:
            pending.done.set()

    def _on_end(self) -> None:
        """Answers all commands that are open, since nothing else will."""
        code: Optional[int] = None
        if self._process is None:
            message = "the window has closed"
        else:
            with contextlib.suppress(subprocess.TimeoutExpired):
                code = self._process.wait(_PATIENCE_S)
            # Its last lines may still be on their way.
            self._threads[1].join(1.0)
            message = f"the program has ended{_reason(code)}"
        if self._is_closed:
            message = "the session is closed"
        with self._lock:
            self._end = ProcessError(message, code, "" if self._is_closed else self.stderr)
            open_commands = list(self._pending.values())
            self._pending.clear()
            for pending in open_commands:
                pending.answer = self._end
        for pending in open_commands:
            pending.done.set()
            if pending.is_abandoned and pending.drop:
                pending.drop()

    @property
    def end(self) -> Optional[ProcessError]:
        """Why the channel has ended; `None` while it has not."""
        return self._end

    def await_end(self) -> Optional[ProcessError]:
        """Why the channel has ended, or does so within seconds; `None` if it goes on."""
        self._threads[-1].join(2.0 * _PATIENCE_S)
        return self._end

    def close(self) -> None:
        """Ends the program, and waits until it has ended. A window that was joined stays open."""
        if os.getpid() != self._owner:
            return
        self._is_closed = True
        if self._process is not None:
            # At once: the end of its input alone would let it finish the commands before.
            self._send({"command": "quit"})
        self._lines.put(None)
        if self._process is not None:
            try:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._process.wait(_PATIENCE_S)
            finally:
                if self._process.poll() is None:
                    self._process.kill()
                self._process.wait()
                for file in (self._process.stdin, self._process.stdout, self._process.stderr):
                    if file:
                        with contextlib.suppress(OSError):
                            file.close()
        elif self._link is not None:
            self._link.close()
        for thread in self._threads:
            if thread is not threading.current_thread():
                thread.join(_PATIENCE_S)

    def _forget(self) -> None:
        """Closes the files in a fork of this process, so that the program ends with its owner. Takes no lock: a thread that is gone may hold it."""
        self._end = ProcessError("the session belongs to the process that has started it; start one in each process")
        files = [self._link] if self._process is None else [self._process.stdin, self._process.stdout, self._process.stderr]
        for file in files:
            with contextlib.suppress(OSError):
                if file is not None:
                    file.close()


def _forget_all() -> None:
    for channel in list(_channels):
        channel._forget()  # pyright: ignore[reportPrivateUsage]


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_all)


def _reason(code: Optional[int]) -> str:
    if code is None:
        return ""
    if code >= 0:
        return f" with exit code {code}"
    with contextlib.suppress(ValueError):
        return f" by the signal {signal.Signals(-code).name}"
    return f" by the signal {-code}"


def _result(command: str, answer: Union[Answer, ProcessError, None]) -> Any:
    """The result of an answer. Raises what it says went wrong."""
    if isinstance(answer, ProcessError):
        # A new one: several threads may raise it, each with its own traceback.
        raise ProcessError(answer.message, answer.code, answer.stderr)
    assert answer is not None
    if answer["event"] == "done":
        return answer.get("result")
    diagnostics = answer.get("diagnostics")
    if diagnostics:
        raise ShaderError([Diagnostic.of(fields) for fields in diagnostics], command, answer)
    if answer["event"] == "restarted":
        raise CrashError(str(answer.get("cause", "the program crashed")), command, str(answer.get("stderr", "")))
    raise CommandError(str(answer.get("message", "")), command, answer)
