"""A chart of materials: a grid of balls that faces the default camera, so that all have the same perspective."""

import math

import numpy as np

from . import shapes
from .glb import NEAREST, Glb
from .raster import bytes_of, srgb

STEP = 2.3  # meters between the centers of the balls, which have radius 1
AZIMUTH_DEG = 30.0  # of the viewer's default camera, from +Z towards +X
PALETTE = np.array([(0.60, 0.58, 0.54), (0.03, 0.20, 0.23), (0.55, 0.12, 0.05), (0.60, 0.34, 0.04), (0.06, 0.08, 0.22)])


def numbers(value):
    """JSON with floats rounded to five decimals."""
    if isinstance(value, dict):
        return {key: numbers(v) for key, v in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [numbers(v) for v in value]
    return round(float(value), 5) if isinstance(value, (float, np.floating)) else value


def about(axis, degrees):
    """A quaternion (x, y, z, w): a rotation around the axis 0, 1 or 2."""
    half = math.radians(degrees) / 2
    turn = [0.0, 0.0, 0.0, math.cos(half)]
    turn[axis] = math.sin(half)
    return numbers(turn)


def dielectric(color, roughness=0.5, **more):
    """A dielectric with a linear base color."""
    return metallic_roughness(color, 0.0, roughness, **more)


def metal(color, roughness=0.5, **more):
    """A metal; its color is its reflectance at normal incidence."""
    return metallic_roughness(color, 1.0, roughness, **more)


def metallic_roughness(color, metallic, roughness, **more):
    """A glTF material with metallic-roughness factors, and additional members."""
    alpha = () if len(color) == 4 else (1.0,)
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, *alpha], "metallicFactor": float(metallic),
                                     "roughnessFactor": float(roughness)}, **more}


def extended(base, **extensions):
    """Adds extensions, named without their prefix KHR_materials_, to the material."""
    mine = {f"KHR_materials_{name}": value for name, value in extensions.items()}
    return {**base, "extensions": {**base.get("extensions", {}), **mine}}


class Chart:
    """A grid of shapes, each with its own material. Row 0 is at the top."""

    def __init__(self, title, columns, rows, ball=None):
        self.glb = Glb()
        self.columns, self.rows = columns, rows
        self.nodes = [{"name": title, "rotation": about(1, AZIMUTH_DEG)}]
        self.ball = ball or shapes.sphere()

    def place(self, row, column):
        """The center of a cell."""
        return [(column - (self.columns - 1) / 2) * STEP, ((self.rows - 1) / 2 - row) * STEP, 0.0]

    def put(self, row, column, name, material, shape=None, tangents=False, **node):
        """Places a shape, by default the ball, at a cell. Writes texture coordinates if the material has a texture."""
        textured = "Texture" in str(material)
        needed = {"POSITION", "NORMAL"} | ({"TEXCOORD_0"} if textured else set()) | ({"TANGENT"} if tangents else set())
        index = self.glb.material(name, **numbers(material))
        primitive = self.glb.primitive(shape or self.ball, index, only=needed, compact=True)
        mesh = self.glb.mesh(name, primitive)
        self.add({"name": name, "mesh": mesh, "translation": numbers(self.place(row, column)), **node})

    def row(self, row, entries, **options):
        """Fills a row from left to right with (name, material)."""
        for column, (name, material) in enumerate(entries):
            self.put(row, column, name, material, **options)

    def add(self, node):
        """A node in the chart's rotated space: x to the right, y up, z towards the viewer."""
        self.nodes.append(node)
        self.nodes[0].setdefault("children", []).append(len(self.nodes) - 1)

    def texture(self, name, pixels, **options):
        """Adds a texture and returns a reference to it, for a material."""
        return {"index": self.glb.texture(name, pixels, **options)}

    def panel(self, pattern=None, cell=0.5, behind=1.9):
        """A wall behind the grid, to be seen through the balls: 8 x 8 repeating cells, one texel each."""
        columns, rows = round((self.columns * STEP + 2.2) / cell), round((self.rows * STEP + 0.8) / cell)
        texture = self.texture("panel", checkers() if pattern is None else pattern, magnified=NEAREST)
        material = self.glb.material("panel", pbrMetallicRoughness={
            "baseColorTexture": texture, "metallicFactor": 0.0, "roughnessFactor": 1.0})
        quad = shapes.quad(columns * cell, rows * cell, repeat=(columns / 8, rows / 8))
        mesh = self.glb.mesh("panel", self.glb.primitive(quad, material, only={"POSITION", "NORMAL", "TEXCOORD_0"}))
        # The camera looks down on the balls, so what is behind them is lower.
        self.add({"name": "panel", "mesh": mesh, "translation": [0.0, round(-0.27 * behind, 3), -behind]})

    def bytes(self):
        """The .glb's bytes."""
        title = self.nodes[0]["name"]
        self.glb.document.update(nodes=self.nodes, scenes=[{"name": title, "nodes": [0]}], scene=0)
        return self.glb.bytes()


def checkers():
    """Alternates colors and off-white. The color changes along the diagonal, which makes refraction visible."""
    x, y = np.meshgrid(np.arange(8), np.arange(8))
    hue = 1 + (x + y) // 2 % (len(PALETTE) - 1)
    return bytes_of(srgb(PALETTE[np.where((x + y) % 2 == 1, hue, 0)]))
