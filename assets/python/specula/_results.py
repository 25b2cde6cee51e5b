"""What commands return."""

from __future__ import annotations

import base64
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union, cast

import numpy as np

from ._picture import Picture

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["Difference", "Furnace", "Media", "Mode", "Probe", "Trace", "TraceLine"]

_KINDS = {".png": "image/png", ".gif": "image/gif", ".webp": "image/webp", ".mp4": "video/mp4"}


class Media:
    """A file in memory that shows itself in Jupyter: a contact sheet or an animation."""

    def __init__(self, data: bytes, ending: str) -> None:
        self.data = data
        """The bytes of the file."""
        self.ending = ending
        """Such as ``.webp``."""

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the file. Raises ``ValueError`` if the path has another ending."""
        if Path(path).suffix.lower() != self.ending:
            raise ValueError(f"{os.fspath(path)}: this is a {self.ending} file")
        Path(path).write_bytes(self.data)

    def __repr__(self) -> str:
        return f"<Media {self.ending}, {len(self.data):,} bytes>"

    def _repr_png_(self) -> Optional[bytes]:
        return self.data if self.ending == ".png" else None

    def _repr_html_(self) -> Optional[str]:
        if self.ending == ".png":
            return None
        url = f"data:{_KINDS[self.ending]};base64,{base64.b64encode(self.data).decode()}"
        if self.ending == ".mp4":
            return f'<video controls loop autoplay muted src="{url}"></video>'
        return f'<img alt="" src="{url}">'


@dataclass(frozen=True)
class Mode:
    """A debug mode: a picture of one channel, term or check."""

    slug: str
    """The name that ``render`` takes, such as ``d``."""
    name: str
    """The title, such as "Normal distribution D"."""
    group: str
    encode: str
    """How its values are shown: ``color``, ``data`` or ``vector``."""
    doc: str

    @classmethod
    def of(cls, fields: Mapping[str, Any]) -> "Mode":
        """The mode that an answer describes."""
        return cls(*(str(fields.get(name) or "") for name in ("slug", "name", "group", "encode", "doc")))


@dataclass(frozen=True)
class Probe:
    """The raw values of a pixel: world space, before exposure and tone map. ``probe["d"]`` has those of a mode."""

    pixel: Tuple[int, int]
    """Counted from the upper left corner."""
    modes: Dict[str, Any]
    """By mode: red, green, blue and coverage; or a number or a name; ``None`` where the mode has no data."""
    textures: List[Dict[str, Any]]
    """The texel at the pixel in each texture of the material."""
    not_finite: Optional[Dict[str, Any]]
    """The first statement that computes NaN or infinity, if a value is one."""

    def __getitem__(self, mode: str) -> "npt.NDArray[np.float64]":
        value = self.modes[mode]
        values = cast("List[Any]", value) if isinstance(value, list) else [value]
        return np.array([np.nan if value in (None, "NaN") else value for value in values], np.float64)

    def __repr__(self) -> str:
        width = max((len(mode) for mode in self.modes), default=0)
        lines = [f"  {mode:{width}}  {_short(value)}" for mode, value in self.modes.items()]
        if self.not_finite:
            lines.append(f"  first NaN or infinity: {self.not_finite}")
        return "\n".join([f"pixel {self.pixel[0]} {self.pixel[1]}", *lines])


@dataclass(frozen=True)
class TraceLine:
    """A line of a shader, and what its statements do at a pixel."""

    file: str
    line: int
    """From 1."""
    code: str
    done: List[Dict[str, Any]]
    """Each with ``act`` (``argument``, ``store``, ``condition``, ``return``, ``discard``), ``name``, ``type``, ``count``, ``first``, ``last``."""

    text: str
    """The same in one line, as ``specula trace`` prints it."""

    def __str__(self) -> str:
        return f"{self.line:>4}  {self.code.strip():<60}  {self.text}".rstrip()


@dataclass(frozen=True)
class Trace:
    """What the statements of a file compute at a pixel. ``trace["a2"]`` is the value that a name has at the end."""

    pixel: Tuple[int, int]
    stage: str
    lines: List[TraceLine]
    equal: Optional[bool]
    """Whether the traced stage ends with the color of the picture, bit by bit."""
    answer: Dict[str, Any] = field(repr=False)
    """All of the answer: as ``specula trace --json`` prints it."""

    @classmethod
    def of(cls, pixel: Tuple[int, int], answer: Dict[str, Any]) -> "Trace":
        """The trace that an answer describes."""
        lines = [TraceLine(line["file"], line["line"], line["code"], line["done"], line["text"]) for line in answer["lines"]]
        proof: Dict[str, Any] = answer.get("proof") or {}
        return cls(pixel, str(answer.get("stage", "")), lines, proof.get("equal"), answer)

    def __getitem__(self, name: str) -> Any:
        """The last value that is stored under a name: a number, a list or a bool. Raises ``KeyError`` if there is none."""
        for line in reversed(self.lines):
            for done in reversed(line.done):
                if done.get("name") == name and (done.get("last") or done.get("first")):
                    return (done.get("last") or done["first"])[-1]["value"]
        names = dict.fromkeys(str(done["name"]) for line in self.lines for done in line.done if done.get("name"))
        reached = f"the values are of {', '.join(names)}" if names else "no statement of the file was reached"
        raise KeyError(f"{name} has no value at this pixel: {reached}")

    def __str__(self) -> str:
        lines = [f"pixel {self.pixel[0]} {self.pixel[1]}, {self.stage}"]
        file = ""
        for line in self.lines:
            if line.file != file:
                file = line.file
                lines.append(file)
            lines.append(str(line))
        return "\n".join(lines)

    __repr__ = __str__


@dataclass(frozen=True)
class Furnace:
    """The directional albedo of the BRDF in a uniform white light: 1 keeps all energy, less loses some, more invents some."""

    roughness: "npt.NDArray[np.float64]"
    """Perceptual roughness of each row, rows values."""
    cos_theta: "npt.NDArray[np.float64]"
    """Cosine of the angle between view and normal of each column, columns values."""
    albedo: "npt.NDArray[np.float64]"
    """rows x columns x 3, linear RGB."""
    claims_conservation: bool
    """Whether the shaders say that this choice conserves energy."""

    @classmethod
    def of(cls, answer: Dict[str, Any]) -> "Furnace":
        """The measurement that an answer describes."""
        rows: Sequence[Mapping[str, Any]] = answer["rows"]
        roughness = list(dict.fromkeys(float(row["roughness"]) for row in rows))
        columns = len(rows) // len(roughness)
        albedo = np.array([[_number(x) for x in row["albedo"]] for row in rows], np.float64)
        cosines = np.array([float(row["cos_theta"]) for row in rows[:columns]])
        return cls(np.array(roughness), cosines, np.reshape(albedo, (-1, columns, 3)), bool(answer["claims_conservation"]))

    @property
    def min(self) -> float:
        """The smallest albedo of all rows, columns and channels."""
        return float(self.albedo.min())

    @property
    def max(self) -> float:
        """The largest one. More than 1.005, the error of the measurement, is energy from nothing."""
        return float(self.albedo.max())

    def picture(self, cell: int = 14) -> Picture:
        """A map: roughness grows downwards, the angle to the right. White is 1, blue loses energy, red invents it, each fully at 0.5."""
        error = np.minimum(np.maximum((np.mean(self.albedo, axis=-1) - 1.0) / 0.5, -1.0), 1.0)[..., np.newaxis]
        end = np.where(error > 0, (0.85, 0.15, 0.1), (0.1, 0.25, 0.7))
        color = 1.0 + np.abs(error) * (end - 1.0)
        cells = np.asarray(np.round(np.nan_to_num(np.asarray(color, np.float64)) * 255.0), np.uint8)
        return Picture(np.repeat(np.repeat(cells, cell, axis=0), cell, axis=1))

    def __repr__(self) -> str:
        claim = "claims" if self.claims_conservation else "does not claim"
        rows, columns = self.albedo.shape[:2]
        return f"<Furnace {rows} roughness x {columns} angles: albedo {self.min:.4f} to {self.max:.4f}; {claim} to conserve energy>"

    def _repr_png_(self) -> Optional[bytes]:
        return self.picture().png()


@dataclass(frozen=True)
class Difference:
    """How two pictures differ. Shows the map of their differences in Jupyter."""

    measure: str
    """``flip`` (8-bit pictures: the mean of FLIP, 0 to 1) or ``rmse`` (raw values, in their own unit)."""
    error: float
    """Infinite where only one of the pictures has NaN or infinity."""
    largest: float
    """The largest difference of a channel."""
    largest_at: Tuple[int, int]
    """The pixel where it is."""
    differing: int
    """Pixels that are not equal bit by bit."""
    pixels: int
    map: Picture = field(repr=False)
    """Where they differ: of FLIP in colors, or of raw values in their own unit."""

    def _repr_png_(self) -> Optional[bytes]:
        return self.map.png()


def _number(value: Any) -> float:
    return float("nan") if value is None or isinstance(value, str) else float(value)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        return " ".join(_short(part) for part in cast("List[Any]", value))
    return "no data" if value is None else str(value)
