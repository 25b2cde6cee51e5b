"""Pictures as arrays that show themselves in Jupyter."""

from __future__ import annotations

import os
import struct
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

from ._exr import exr

if TYPE_CHECKING:
    import numpy.typing as npt

    _Array = np.ndarray[Any, np.dtype[Any]]
else:
    _Array = np.ndarray

__all__ = ["Picture", "tile"]


class Picture(_Array):
    """A picture: an array of height x width x 4 (red, green, blue, coverage), the upper left pixel first.

    ``uint8`` holds the picture as a screen shows it (sRGB), ``float32`` the raw values: linear light before exposure and tone map, or
    what the mode computes, in its own unit. Slices are pictures, too: ``picture[..., 0]`` shows a channel in gray.
    """

    mode: str
    """The debug mode; ``final`` is the picture."""
    encode: str
    """How a screen shows raw values: ``color`` (linear light), ``data`` (0 to 1 as it is), ``vector`` (-1 to 1)."""

    def __new__(cls, array: "npt.ArrayLike", mode: str = "", encode: str = "color") -> "Picture":
        values: Any = np.asarray(array)
        picture: Picture = values.view(cls)
        picture.mode = mode
        picture.encode = encode
        return picture

    def __array_finalize__(self, obj: Any) -> None:
        self.mode = getattr(obj, "mode", "")
        self.encode = getattr(obj, "encode", "color")

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        # A mean of all pixels is a number, not a picture without pixels.
        return array[()] if array.ndim == 0 else Picture(array, self.mode, self.encode)

    def __reduce__(self) -> Any:
        # ndarray's own leaves the attributes out.
        return (Picture, (np.asarray(self), self.mode, self.encode))

    def __repr__(self) -> str:
        if self.ndim not in (2, 3):
            return super().__repr__()
        size = " x ".join(str(side) for side in (self.shape[1], self.shape[0], *self.shape[2:]))
        return f"<Picture {size} {self.dtype}{', mode ' + self.mode if self.mode else ''}>"

    def display(self) -> "npt.NDArray[np.uint8]":
        """The picture as 8 bits for a screen. Raw values are clipped, without a tone map; NaN is magenta."""
        values = np.asarray(self)
        if values.dtype == np.uint8:
            return values
        is_nan = np.isnan(values)
        low = np.nan_to_num(values.astype(np.float64))
        color, alpha = (low[..., :3], low[..., 3:]) if low.ndim == 3 else (low, low[..., :0])
        if self.encode == "vector":
            color = color * 0.5 + 0.5
        color = np.minimum(np.maximum(color, 0.0), 1.0)
        if self.encode == "color" and low.ndim == 3:
            color = np.where(color <= 0.0031308, color * 12.92, 1.055 * color ** (1 / 2.4) - 0.055)
        shown = np.concatenate([color, np.minimum(np.maximum(alpha, 0.0), 1.0)], axis=-1) if low.ndim == 3 else color
        eight = np.round(shown * 255.0).astype(np.uint8)
        if low.ndim == 3 and low.shape[2] >= 3 and bool(is_nan.any()):
            eight[is_nan.any(axis=-1), :3] = (255, 0, 255)
        return eight

    def png(self) -> bytes:
        """The picture as a PNG file. Raises ``ValueError`` if this part of a picture has no PNG."""
        data = _png(self.display())
        if data is None:
            raise ValueError(f"an array of shape {self.shape} is no picture: expected height x width, with 1 to 4 channels")
        return data

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes a ``.png`` (as a screen shows it), an ``.exr`` (raw values alone) or a ``.npy`` (the values themselves)."""
        ending = Path(path).suffix.lower()
        if ending == ".npy":
            with open(path, "wb") as file:
                np.save(file, np.asarray(self))
        elif ending == ".png":
            Path(path).write_bytes(self.png())
        elif ending == ".exr":
            values = np.asarray(self) if self.ndim == 3 else np.asarray(self)[..., np.newaxis]
            if values.dtype != np.float32 or values.ndim != 3 or values.shape[2] not in (1, 3, 4):
                raise ValueError(f"{os.fspath(path)}: an .exr holds raw values, as render(raw=True) returns them, of 1, 3 or 4 channels")
            Path(path).write_bytes(exr(values))
        else:
            raise ValueError(f"{os.fspath(path)}: a picture is saved as .png, .exr or .npy")

    def _repr_png_(self) -> Optional[bytes]:
        return _png(self.display()) if self.ndim in (2, 3) else None


def tile(pictures: Sequence[Picture], columns: Optional[int] = None) -> Picture:
    """Pictures of one size side by side, in rows of ``columns``; without it, in one row. Cells that are left are 0.

    Raises ``ValueError`` if the sizes or the kinds of their values differ.
    """
    arrays = [np.asarray(picture) for picture in pictures]
    if not arrays or any(array.shape != arrays[0].shape or array.dtype != arrays[0].dtype for array in arrays):
        found = ", ".join(f"{array.shape} {array.dtype}" for array in arrays)
        raise ValueError(f"expected pictures of one size and kind, found {found or 'none'}")
    across = max(columns or len(arrays), 1)
    arrays += [np.zeros_like(arrays[0])] * (-len(arrays) % across)
    rows = [np.concatenate(arrays[at : at + across], axis=1) for at in range(0, len(arrays), across)]
    return Picture(np.concatenate(rows, axis=0), pictures[0].mode, pictures[0].encode)


def _png(pixels: "npt.NDArray[np.uint8]") -> Optional[bytes]:
    """Encodes height x width, with 1 (gray), 2 (gray, alpha), 3 or 4 channels."""
    if pixels.ndim == 2:
        pixels = pixels[..., np.newaxis]
    if pixels.ndim != 3 or 0 in pixels.shape or pixels.shape[2] > 4:
        return None
    height, width, channels = pixels.shape
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    # Each byte less the one above it, which the decoder adds again: filter 2, Up.
    rows = np.reshape(pixels, (height, width * channels))
    lines = np.full((height, width * channels + 1), 2, np.uint8)
    lines[0, 1:] = rows[0]
    lines[1:, 1:] = rows[1:] - rows[:-1]

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    body = zlib.compress(lines.tobytes(), 6)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")
