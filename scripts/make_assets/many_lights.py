"""The corner of a room, with balls, under 160 lights: 144 colored points among the balls, 16 spots from above."""

import colorsys

from . import shapes
from .chart import about, dielectric, metal, numbers
from .glb import Glb

SIZE, HEIGHT = 15.0, 6.0  # of the room, meters
STEP = 2.8  # between balls
USED = {"POSITION", "NORMAL"}


class Scene:
    """A model of nodes under one root, and lights."""

    def __init__(self):
        self.glb = Glb()
        self.nodes = [{"name": "Many lights", "children": []}]
        self.lights = []

    def mesh(self, name, shape, material):
        """A mesh of a shape with its own material."""
        index = self.glb.material(name, **material)
        return self.glb.mesh(name, self.glb.primitive(shape, index, only=USED, compact=True))

    def add(self, name, place, **node):
        """A node at a position."""
        self.nodes.append({"name": name, "translation": numbers(place), **node})
        self.nodes[0]["children"].append(len(self.nodes) - 1)

    def light(self, kind, place, color, candela, reach, node=None, **more):
        """A light in its own node."""
        name = f"{kind} {len(self.lights) + 1}"
        self.lights.append(numbers(
            {"name": name, "type": kind, "color": color, "intensity": candela, "range": reach, **more}))
        self.add(name, place, **(node or {}), extensions={"KHR_lights_punctual": {"light": len(self.lights) - 1}})


def build():
    """The .glb's bytes."""
    scene = Scene()
    room(scene)
    balls(scene)
    points(scene)
    spots(scene)
    document = scene.glb.document
    document["extensions"] = {"KHR_lights_punctual": {"lights": scene.lights}}
    document.update(nodes=scene.nodes, scenes=[{"name": scene.nodes[0]["name"], "nodes": [0]}], scene=0)
    return scene.glb.bytes()


def room(scene):
    """A slightly glossy floor and two walls."""
    floor = scene.mesh("floor", shapes.quad(SIZE, SIZE), dielectric((0.30, 0.30, 0.31), 0.3))
    wall = scene.mesh("wall", shapes.quad(SIZE, HEIGHT), dielectric((0.60, 0.59, 0.57), 0.8))
    scene.add("floor", [0.0, 0.0, 0.0], mesh=floor, rotation=about(0, -90.0))
    scene.add("back wall", [0.0, HEIGHT / 2, -SIZE / 2], mesh=wall)
    scene.add("left wall", [-SIZE / 2, HEIGHT / 2, 0.0], mesh=wall, rotation=about(1, 90.0))


def balls(scene):
    """5 x 5 balls of three materials."""
    ball = shapes.sphere()
    kinds = {"white": dielectric((0.7, 0.7, 0.7), 0.4), "black": dielectric((0.02, 0.02, 0.02), 0.12),
             "steel": metal((0.56, 0.57, 0.58), 0.25)}
    meshes = [(name, scene.mesh(name, ball, material)) for name, material in kinds.items()]
    for row in range(5):
        for column in range(5):
            name, mesh = meshes[(row + 2 * column) % 3]
            scene.add(f"{name} ball", [(column - 2) * STEP, 0.8, (row - 2) * STEP], mesh=mesh, scale=[0.8] * 3)


def points(scene):
    """6 x 6 x 4 between the balls and above them; each level has its part of the color circle."""
    for level, height in enumerate((0.45, 1.7, 3.1, 4.6)):
        for row in range(6):
            for column in range(6):
                hue = (level * 9 + (column + 2 * row) % 9) / 36.0
                place = [(column - 2.5) * STEP * 0.9, height, (row - 2.5) * STEP * 0.9]
                scene.light("point", place, colorsys.hsv_to_rgb(hue, 0.85, 1.0), 1.6, 4.5)


def spots(scene):
    """4 x 4 spots that point straight down, alternately warm and cold."""
    cone = {"innerConeAngle": 0.2, "outerConeAngle": 0.35}
    for row in range(4):
        for column in range(4):
            place = [(column - 1.5) * STEP, HEIGHT, (row - 1.5) * STEP]
            color = (1.0, 0.88, 0.7) if (row + column) % 2 else (0.72, 0.86, 1.0)
            scene.light("spot", place, color, 40.0, 10.0, node={"rotation": about(0, -90.0)}, spot=cone)
