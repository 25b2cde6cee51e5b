"""Writes PNG images and GLB files, with only numpy and the standard library."""

import json
import struct
import zlib

import numpy as np

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
NEAREST, LINEAR, LINEAR_MIPMAP_LINEAR, REPEAT = 9728, 9729, 9987, 10497
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


def png(pixels):
    """PNG bytes of a (height, width, 3 or 4) uint8 array. Each row uses the filter with the smallest residuals."""
    height, width, channels = pixels.shape
    raw = pixels.reshape(height, width * channels).astype(np.int16)
    up = np.vstack([np.zeros((1, raw.shape[1]), np.int16), raw[:-1]])
    left = np.hstack([np.zeros((height, channels), np.int16), raw[:, :-channels]])
    up_left = np.hstack([np.zeros((height, channels), np.int16), up[:, :-channels]])
    estimate = left + up - up_left
    to_left, to_up, to_up_left = (np.abs(estimate - p) for p in (left, up, up_left))
    paeth = np.where((to_left <= to_up) & (to_left <= to_up_left), left, np.where(to_up <= to_up_left, up, up_left))
    residuals = np.stack([(raw - p) & 255 for p in (np.zeros_like(raw), left, up, (left + up) >> 1, paeth)])
    cost = np.minimum(residuals, 256 - residuals).sum(axis=2)
    choice = cost.argmin(axis=0)
    rows = np.empty((height, raw.shape[1] + 1), np.uint8)
    rows[:, 0] = choice
    rows[:, 1:] = residuals[choice, np.arange(height)]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


class Glb:
    """A glTF document under construction. Write what needs no buffer directly to `document`."""

    def __init__(self):
        self.document = {
            "asset": {"version": "2.0", "generator": "Specula scripts/make-assets", "copyright": "CC0 1.0"},
            "accessors": [], "bufferViews": [], "meshes": [], "materials": [],
        }
        self.binary = bytearray()
        self._accessors = {}

    def _view(self, data, **extra):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.document["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **extra})
        self.binary += data
        return len(self.document["bufferViews"]) - 1

    def _accessor(self, array, component, kind, target, **extra):
        """Returns an accessor of these values. Equal values share one accessor."""
        data = array.tobytes()
        key = (data, component, kind, target)
        if key not in self._accessors:
            view = self._view(data, target=target)
            self._accessors[key] = len(self.document["accessors"])
            self.document["accessors"].append(
                {"bufferView": view, "componentType": component, "count": len(array), "type": kind})
        index = self._accessors[key]
        self.document["accessors"][index].update(extra)
        return index

    def primitive(self, surface, material, only=None, compact=False):
        """A triangle primitive of a `geometry.Surface`; `only` names the attributes to write.

        `compact` stores texture coordinates, which must be within 0..1, in 16 bits, and the rest to six decimals, so
        that no byte depends on the last bit of a machine's sine.
        """
        attributes = {}
        for name, array in surface.attributes.items():
            if only is not None and name not in only:
                continue
            if compact and name == "TEXCOORD_0":
                array = np.floor(np.asarray(array) * 65535.0 + 0.5).astype("<u2")
                attributes[name] = self._accessor(array, UINT16, "VEC2", ARRAY_BUFFER, normalized=True)
                continue
            if compact:
                array = np.round(array, 6) + 0.0  # no negative zeros
            array = np.ascontiguousarray(array, "<f4")
            bounds = {}
            if name == "POSITION":
                bounds = {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
            attributes[name] = self._accessor(array, FLOAT, f"VEC{array.shape[1]}", ARRAY_BUFFER, **bounds)
        small = len(surface.attributes["POSITION"]) < 65536
        indices = np.ascontiguousarray(surface.triangles.reshape(-1), "<u2" if small else "<u4")
        index = self._accessor(indices, UINT16 if small else UINT32, "SCALAR", ELEMENT_ARRAY_BUFFER)
        return {"attributes": attributes, "indices": index, "material": material}

    def mesh(self, name, primitive):
        """Adds a mesh of one primitive and returns its index."""
        self.document["meshes"].append({"name": name, "primitives": [primitive]})
        return len(self.document["meshes"]) - 1

    def material(self, name, **properties):
        """Adds a material and returns its index."""
        self.document["materials"].append({"name": name, **properties})
        return len(self.document["materials"]) - 1

    def texture(self, name, pixels, magnified=LINEAR):
        """Adds a repeating, trilinear texture and returns its index; `magnified` NEAREST keeps texels sharp."""
        d = self.document
        sampler = {"magFilter": magnified, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": REPEAT, "wrapT": REPEAT}
        samplers = d.setdefault("samplers", [])
        if sampler not in samplers:
            samplers.append(sampler)
        view = self._view(png(pixels))
        d.setdefault("images", []).append({"name": name, "mimeType": "image/png", "bufferView": view})
        d.setdefault("textures", []).append(
            {"name": name, "sampler": samplers.index(sampler), "source": len(d["images"]) - 1})
        return len(d["textures"]) - 1

    def bytes(self):
        """The file: header, JSON chunk, binary chunk."""
        self.binary += b"\0" * (-len(self.binary) % 4)
        document = {**self.document, "buffers": [{"byteLength": len(self.binary)}]}
        if used := _extensions(self.document):
            document["extensionsUsed"] = sorted(used)
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(self.binary)
        return b"".join([
            struct.pack("<4sII", b"glTF", 2, total),
            struct.pack("<I4s", len(text), b"JSON"), text,
            struct.pack("<I4s", len(self.binary), b"BIN\0"), bytes(self.binary),
        ])


def _extensions(value):
    """The names of all extensions anywhere in a document."""
    if isinstance(value, list):
        return set().union(*map(_extensions, value))
    if not isinstance(value, dict):
        return set()
    return set(value.get("extensions", ())).union(*map(_extensions, value.values()))
