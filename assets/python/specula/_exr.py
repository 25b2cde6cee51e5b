"""Writes pictures with raw floats as OpenEXR files: scan lines, 32-bit floats, uncompressed."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, List

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["exr"]

# Channels lie in the order of their names.
_ORDER = {1: ("Y",), 3: ("B", "G", "R"), 4: ("A", "B", "G", "R")}
_INDEX = {"Y": 0, "R": 0, "G": 1, "B": 2, "A": 3}


def exr(values: "npt.NDArray[np.float32]") -> bytes:
    """The file of height x width x 1, 3 or 4 floats."""
    height, width, count = values.shape
    names = _ORDER[count]

    def attribute(name: str, kind: str, data: bytes) -> bytes:
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    # Each channel: type 2 is float; sampled at each pixel.
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = b"".join(
        [
            struct.pack("<ii", 20000630, 2),
            attribute("channels", "chlist", channels),
            attribute("compression", "compression", b"\0"),
            attribute("dataWindow", "box2i", window),
            attribute("displayWindow", "box2i", window),
            attribute("lineOrder", "lineOrder", b"\0"),
            attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
            attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
            attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)),
            b"\0",
        ]
    )
    line_bytes = 4 * width * count
    first = len(head) + 8 * height
    offsets = first + (8 + line_bytes) * np.arange(height, dtype="<u8")
    planes = np.moveaxis(values[..., [_INDEX[name] for name in names]].astype("<f4"), 2, 1)
    lines: List[bytes] = [head, offsets.tobytes()]
    for y in range(height):
        lines += [struct.pack("<ii", y, line_bytes), np.ascontiguousarray(planes[y]).tobytes()]
    return b"".join(lines)
