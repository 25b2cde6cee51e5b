"""7 x 5 spheres of one mesh: roughness grows to the right, metallic upwards. Factors only, no textures."""

import numpy as np

from . import geometry
from .glb import Glb

COLUMNS, ROWS, RADIUS, STEP = 7, 5, 0.42, 1.0
PAINT, METAL = np.array([0.62, 0.12, 0.075]), np.array([0.95, 0.68, 0.34])


def build():
    """The .glb's bytes."""
    glb = Glb()
    profile = geometry.joined(geometry.arc((0, 0), RADIUS, 180.0, 0.0, 49))
    profile.points[[0, -1], 0] = 0.0
    surface = geometry.checked(geometry.revolve(profile, 96, profile.length / profile.length[-1]))
    primitive = glb.primitive(surface, 0)
    nodes = [{"name": "Sphere grid", "children": list(range(1, 1 + COLUMNS * ROWS))}]
    for row in range(ROWS):
        for column in range(COLUMNS):
            roughness, metallic = column / (COLUMNS - 1), row / (ROWS - 1)
            color = PAINT + (METAL - PAINT) * metallic
            name = f"roughness {roughness:.2f}, metallic {metallic:.2f}"
            material = glb.material(name, pbrMetallicRoughness={
                "baseColorFactor": [*(round(float(c), 4) for c in color), 1.0],
                "metallicFactor": metallic, "roughnessFactor": roughness,
            })
            mesh = glb.mesh(name, {**primitive, "material": material})
            place = [(column - (COLUMNS - 1) / 2) * STEP, (row - (ROWS - 1) / 2) * STEP, 0.0]
            nodes.append({"name": name, "mesh": mesh, "translation": place})
    glb.document.update(nodes=nodes, scenes=[{"name": "Sphere grid", "nodes": [0]}], scene=0)
    return glb.bytes()
