"""A session: one program that stays warm."""

from __future__ import annotations

import contextlib
import operator
import os
import threading
import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union, cast

import numpy as np

from ._channel import Channel
from ._errors import CommandError, CrashError, Diagnostic, ShaderError
from ._memory import Memory
from ._picture import Picture
from ._program import find_program
from ._results import Difference, Furnace, Media, Mode, Probe, Trace
from ._scratch import Scratch

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["PathLike", "Session", "Size"]

PathLike = Union[str, "os.PathLike[str]"]
Size = Tuple[int, int]
"""Width and height, pixels."""

# None is a value of some settings.
_NOTHING: Any = object()

# The fields of the command, where the arguments of a session have other names
_OPENED = {"env": "environment", "shaders": "tree"}

_ROOTS: "weakref.WeakSet[Scratch]" = weakref.WeakSet()


class Session:
    """A program that renders, and keeps its device, shaders and light from call to call.

    ``model`` is a file (.gltf, .glb or .zip) or the name of a built-in one, ``shaders`` the folder of a shader tree or a single file,
    ``env`` an .hdr or .exr, ``studio``, ``sky``, ``furnace``, ``model`` or ``none``, ``size`` width and height of a picture in pixels
    (640, 360 by default), ``device`` a part of the name of a GPU. ``window=True`` opens a window that you see, too, of that size if one is
    given; ``window="demo"`` joins the one that ``specula view --socket demo`` has opened, with its own model and settings. ``options`` are
    more options of ``specula render``, such as ``["--lights", "none"]``; ``program`` is the path of ``specula``.

    World space is right-handed with +Y up, in meters; angles are in degrees; pixels are counted from the upper left corner. All methods
    may be called from several threads. Ctrl+C ends a call, not the session. A session ends with its ``with`` block, by :meth:`close`, when
    nothing refers to it any more, or with the interpreter, and leaves no process and no file behind.

    Raises :class:`ProgramNotFound`, or :class:`ProcessError` with what the program has printed if it could not start.
    """

    def __init__(
        self,
        model: Optional[PathLike] = None,
        *,
        shaders: Optional[PathLike] = None,
        env: Optional[PathLike] = None,
        size: Optional[Size] = None,
        device: Optional[str] = None,
        window: Union[bool, str] = False,
        options: Sequence[str] = (),
        program: Optional[PathLike] = None,
    ) -> None:
        chosen = _size(size) or [640, 360]
        if isinstance(options, str):
            raise TypeError(f"options={options!r}: a list of words is expected, such as {options.split()!r}")
        self._scratch = Scratch()
        width, height = chosen
        self._size: Optional[Size] = (width, height)
        self._program = ""
        self._modes: Dict[str, Mode] = {}
        self._checking = threading.Lock()
        if isinstance(window, str):
            if model is not None or shaders is not None or env is not None or device is not None or options:
                raise ValueError("a window that is joined has its model, shaders, environment and device; change them with open() and set()")
            self._size = None
            self._memory = Memory(0)
            self._channel = Channel.join(_socket_path(window))
        else:
            self._program = find_program(program)
            arguments = [self._program, *(["view", "--events", "json"] if window else ["serve"])]
            if model is not None:
                arguments.append(os.fspath(model))
            for option, value in (("--shaders", shaders), ("--env", env), ("--device", device)):
                if value is not None:
                    arguments += [option, os.fspath(value)]
            if size or not window:
                arguments += ["--size", f"{width}x{height}"]
            arguments += options
            self._memory = Memory()
            try:
                self._channel = Channel.start(arguments, self._memory.files)
            except BaseException:
                self._memory.close()
                raise
        self._finalizer = weakref.finalize(self, _end, self._channel, self._scratch, self._memory)
        _ROOTS.add(self._scratch)
        try:
            # Wrong options end the program, which has printed why.
            self.command("get", path="mode")
        except CommandError as error:
            # A program that ends may still refuse the command.
            end = self._channel.await_end()
            self.close()
            raise end or error from None
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "closed" if not self._finalizer.alive else "ended" if self._channel.end else f"process {self._channel.pid}"
        return f"<specula.Session, {state}>"

    def close(self) -> None:
        """Ends the program and removes its files. A window that was joined stays open. Calls of other threads fail."""
        self._finalizer()

    # Pictures

    def render(self, mode: Optional[str] = None, *, size: Optional[Size] = None, raw: bool = False) -> Picture:
        """Draws a picture: an array of height x width x 4, which shows itself in Jupyter.

        ``mode`` is the name of a debug mode (:meth:`modes`), such as ``d``; without it, the one that the settings have. ``size`` is width
        and height. ``raw=True`` gives ``float32`` without exposure and tone map: linear light, premultiplied by its coverage, or the values of the
        mode in their own unit and space; else ``uint8`` as a screen shows it, as a PNG has it.
        """
        fields: Dict[str, Any] = {"mode": mode, "raw": raw, "size": _size(size or self._size)}
        given = {key: value for key, value in fields.items() if value is not None}
        array = self._picture(given)
        shown = mode if mode is not None else str(self.get("mode")) if raw else ""
        return Picture(array, shown, self._encoding(shown) if raw else "color")

    def sheet(
        self, modes: Union[str, Sequence[str]] = "modes", *, size: Optional[Size] = None, columns: Optional[int] = None
    ) -> Media:
        """Draws a contact sheet with the names of the modes: ``modes`` (those with data), ``all``, or a list. ``size`` is that of one picture."""
        chosen = modes if isinstance(modes, str) else list(modes)
        return self._media("sheet", ".png", {"modes": chosen, "size": _size(size), "columns": columns})

    def turntable(
        self,
        ending: str = ".webp",
        *,
        frames: int = 36,
        fps: float = 18.0,
        size: Optional[Size] = (320, 180),
        turn: str = "camera",
    ) -> Media:
        """Draws a full turn of the ``camera``, the ``light`` or the ``model`` as an animation (.webp, .gif or .mp4) that plays in Jupyter.

        ``fps`` is in frames a second.
        """
        return self._media("turntable", ending, {"frames": frames, "fps": fps, "size": _size(size or self._size), "turn": turn})

    # Settings

    def set(self, path: Union[str, Mapping[str, Any], None] = None, value: Any = _NOTHING, **values: Any) -> None:
        """Changes settings, all or none; returns when their picture is complete.

        ``s.set("view.ev", 1)``, ``s.set({"view.ev": 1, "mode": "d"})``, ``s.set(NDF="Beckmann", material={"enabled": True})``. The names are those
        of ``specula help set``, and the constants and parameters of the shaders. Raises :class:`CommandError` if a name or a value is wrong.
        """
        changed: Dict[str, Any] = dict(values)
        if isinstance(path, str):
            if value is _NOTHING:
                raise TypeError(f"set({path!r}) lacks a value")
            changed[path] = value
        elif path is not None:
            changed.update(path)
        self.command("set", values=_plain(changed))

    def get(self, path: Optional[str] = None) -> Any:
        """The value of a setting, or all of them as a dictionary."""
        return self.command("get", path=path)

    def __setitem__(self, path: str, value: Any) -> None:
        """``s["view.ev"] = 1`` is ``s.set("view.ev", 1)``."""
        self.set(path, value)

    def __getitem__(self, path: str) -> Any:
        """``s["view.ev"]`` is ``s.get("view.ev")``."""
        return self.get(path)

    def open(self, **what: PathLike) -> None:
        """Opens another ``model=``, ``env=``, ``shaders=``, ``look=`` or ``measured=`` BRDF; ``beside=`` adds a model."""
        if not what:
            raise TypeError("open() takes one or more of model, env, shaders, look, measured and beside")
        for kind, path in what.items():
            self.command("open", **{_OPENED.get(kind, kind): os.fspath(path)})
        self._modes = {}

    def modes(self) -> List[Mode]:
        """All debug modes of the shaders."""
        modes = [Mode.of(fields) for fields in self.command("modes")]
        self._modes = {mode.slug: mode for mode in modes}
        return modes

    # Shaders

    @property
    def tree(self) -> Optional[Path]:
        """The folder of the shaders, or their single file; ``None`` for the built-in ones."""
        root = self.command("files").get("tree")
        return None if root is None else Path(root)

    def files(self) -> List[str]:
        """The files of the shader tree."""
        return [str(file) for file in self.command("files")["files"]]

    def read(self, file: str) -> str:
        """The text of a file of the tree, such as ``brdf/ndf.glsl``."""
        return str(self.command("file", file=file)["text"])

    def edit(self, file: str, text: Optional[str], *, base: Optional[str] = None) -> None:
        """Changes a file of the tree, or makes it; returns when its picture is complete, with the light that it changes.

        Raises :class:`ShaderError` if it does not compile: the message shows the line and its caret. The file has the text then, and the
        picture is that of the last good shaders. The built-in shaders change in the memory of the session alone, and ``None`` brings back their own
        text; to keep a change, write them to a folder with ``specula new`` and give it as ``shaders``.

        With ``base``, the text that was edited, changes that an editor has saved since are kept; where both changed a line, the file stays and
        :class:`SpeculaError` is raised.
        """
        self._modes = {}
        # None is a value here.
        fields: Dict[str, Any] = {"file": file, "text": text}
        self._channel.ask("edit", fields if base is None else {**fields, "base": base})

    def check(self) -> List[Diagnostic]:
        """Compiles all files of the tree. Returns the warnings; raises :class:`ShaderError` if there is an error."""
        found = [Diagnostic.of(fields) for fields in self.command("check")]
        if any(diagnostic.severity == "error" for diagnostic in found):
            raise ShaderError(found, "check")
        return found

    def checks(self, *, undefined: bool = False) -> List[Dict[str, Any]]:
        """Draws the picture and looks at each ``assert()`` and ``print()``; with ``undefined``, also at operations whose result GLSL leaves open.

        Returns what failed or was printed, with ``file``, ``line``, ``message``, ``count`` and ``first`` (the first pixel).
        """
        # The kind is a setting, which another thread's checks would change.
        with self._checking:
            before = self.get("view.checks")
            try:
                self.set("view.checks", "undefined" if undefined else "assertions")
                found: List[Dict[str, Any]] = self.command("checks")
            finally:
                self.set("view.checks", before)
            return found

    # Values

    def probe(self, x: int, y: int, modes: Union[str, Sequence[str], None] = None) -> Probe:
        """Reads the raw values of a pixel in a mode, or in a list of modes; without them, in all but those of random paths, which takes
        longer.
        """
        chosen = [modes] if isinstance(modes, str) else modes
        answer = self.command("probe", at=[x, y], modes=None if chosen is None else list(chosen))
        return Probe((x, y), answer["modes"], answer["textures"], answer.get("not_finite"))

    def trace(self, x: int, y: int, file: str = "pbr.frag", *, stage: Optional[str] = None) -> Trace:
        """Runs the shaders at a pixel with a log: what each statement of a file computes there. The first trace of a file compiles a pipeline.

        ``stage`` is a stage of the picture, such as ``tonemap.frag``; without it, the one that draws the pixel and has the file.
        """
        return Trace.of((x, y), self.command("trace", at=[x, y], file=file, stage=stage))

    def furnace(self, *, metallic: float = 1.0, base_color: Sequence[float] = (1.0, 1.0, 1.0)) -> Furnace:
        """Measures the directional albedo by roughness and angle, with the present values of constants and parameters.

        ``metallic`` is 0 (dielectric) to 1 (metal), ``base_color`` linear RGB, each 0 to 1.
        """
        return Furnace.of(self.command("furnace", metallic=metallic, base_color=[float(x) for x in base_color]))

    def diff(self, a: Union[Picture, PathLike], b: Union[Picture, PathLike]) -> Difference:
        """Compares two pictures of one size: arrays that :meth:`render` has returned, or files (.png or .exr)."""
        temporary: List[Path] = []
        try:
            paths = [self._path_of(picture, temporary) for picture in (a, b)]
            out = self._scratch.path(".npy")
            temporary.append(out)
            answer = self.command("diff", a=paths[0], b=paths[1], out=str(out))
            pair = answer["pictures"][0]
            if "why" in pair:
                raise ValueError(str(pair["why"]))
            shown = Picture(np.load(out, allow_pickle=False))
        finally:
            for path in temporary:
                _remove(path)
        at = pair["largest_at"]
        return Difference(
            str(pair["measure"]), _size_of(pair["error"]), _size_of(pair["largest"]), (at[0], at[1]), pair["differing"], pair["pixels"], shown
        )

    # Everything else

    def command(self, name: str, **fields: Any) -> Any:
        """Sends any command of ``specula help commands`` and returns its result. Fields that are ``None`` are left out.

        Raises :class:`CommandError` if it is refused, :class:`ShaderError` if the shaders are wrong, and :class:`ProcessError` if the program
        has ended.
        """
        return self._channel.ask(name, {key: value for key, value in fields.items() if value is not None})

    @property
    def log(self) -> str:
        """The last warnings that the program has printed."""
        return self._channel.stderr

    def _picture(self, fields: Dict[str, Any]) -> "npt.NDArray[Any]":
        """The array of a picture: by a file in memory that the program has open, too, or else by one of the session."""
        number = self._memory.take()
        if number is None:
            path = self._ask_file("picture", ".npy", fields)
            try:
                return np.load(path, allow_pickle=False)
            finally:
                _remove(path)
        # After an interruption, the program may still write to it.
        memory = self._memory
        given = {**fields, "file": f"/proc/self/fd/{number}", "format": "npy"}
        try:
            self._channel.ask("picture", given, drop=lambda: memory.give_back(number))
        except CrashError:
            # The next process may still answer, and write.
            raise
        except CommandError:
            self._memory.give_back(number)
            raise
        try:
            return self._memory.read(number)
        finally:
            self._memory.give_back(number)

    def _ask_file(self, command: str, ending: str, fields: Dict[str, Any]) -> Path:
        """Lets a command write a file of the session."""
        path = self._scratch.path(ending)
        given = {**{key: value for key, value in fields.items() if value is not None}, "file": str(path)}
        try:
            self._channel.ask(command, given, drop=lambda: _remove(path))
        except Exception:
            _remove(path)
            raise
        return path

    def _media(self, command: str, ending: str, fields: Dict[str, Any]) -> Media:
        path = self._ask_file(command, ending, fields)
        try:
            return Media(path.read_bytes(), ending)
        finally:
            _remove(path)

    def _path_of(self, picture: Union[Picture, PathLike], temporary: List[Path]) -> str:
        """The file of a picture."""
        if not isinstance(picture, np.ndarray):
            return os.path.abspath(os.fspath(picture))
        path = self._scratch.path(".png" if picture.dtype == np.uint8 else ".exr")
        temporary.append(path)
        picture.save(path)
        return str(path)

    def _encoding(self, mode: str) -> str:
        if mode not in self._modes:
            self.modes()
        found = self._modes.get(mode)
        return found.encode if found else "color"


def _end(channel: Channel, scratch: Scratch, memory: Memory) -> None:
    try:
        channel.close()
    finally:
        scratch.remove()
        memory.close()


def _forget_locks() -> None:
    for scratch in list(_ROOTS):
        scratch.forget()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_locks)


def _remove(path: Path) -> None:
    with contextlib.suppress(OSError):
        path.unlink()


def _size(size: Optional[Size]) -> Optional[List[int]]:
    if size is None:
        return None
    # Not all programs are checked for types.
    given: Any = size
    try:
        width, height = given
        return [operator.index(width), operator.index(height)]
    except (TypeError, ValueError):
        raise TypeError(f"size={given!r}: width and height are expected, such as (640, 360)") from None


def _size_of(difference: Any) -> float:
    """A difference, for which JSON has no infinity: that of NaN and a number."""
    return float("inf") if difference is None else float(difference)


def _plain(value: Any) -> Any:
    """A value as JSON takes it: arrays and numbers of numpy become lists and numbers."""
    if isinstance(value, (np.ndarray, np.generic)):
        return cast("Any", value).tolist()
    if isinstance(value, Mapping):
        parts = cast("Mapping[Any, Any]", value)
        return {str(key): _plain(part) for key, part in parts.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(part) for part in cast("Sequence[Any]", value)]
    return os.fspath(cast("os.PathLike[str]", value)) if isinstance(value, os.PathLike) else value


def _socket_path(name: str) -> str:
    """The path of a socket: a path, or a name without a slash, as ``specula view --socket`` takes it."""
    if "/" in name:
        return os.path.abspath(name)
    folder = os.environ.get("XDG_RUNTIME_DIR")
    if not folder:
        raise ValueError(f"window={name!r}: XDG_RUNTIME_DIR is not set; give the path of the socket")
    return os.path.join(folder, "specula", name if "." in name else name + ".sock")
