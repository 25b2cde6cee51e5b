"""Charts of the extensions for transmission, in front of a colored wall that makes refraction visible."""

import numpy as np

from . import patterns, shapes
from .chart import Chart, about, dielectric, extended, numbers
from .raster import bytes_of

QUARTERS = (0.0, 0.33, 0.67, 1.0)
CLEAR = (1.0, 1.0, 1.0)
BALL = {"thicknessFactor": 2.0}  # a solid ball of radius 1, at its center
OPEN = {"transmissionFactor": 1.0}


def ior():
    """Index of refraction: reflection of a dark plastic, and refraction of a solid ball."""
    chart = Chart("Index of refraction", 4, 2)
    names = {1.0: "air", 1.33: "water", 1.5: "glass", 2.42: "diamond"}
    plastic, clear = dielectric((0.02, 0.025, 0.03), 0.15), dielectric(CLEAR, 0.0)
    chart.row(0, [(f"ior {i}, {name}", extended(plastic, ior={"ior": i})) for i, name in names.items()])
    chart.row(1, [(f"ior {i}, {name}, solid", extended(clear, ior={"ior": i}, transmission=OPEN, volume=BALL))
                  for i, name in names.items()])
    chart.panel()
    return chart.bytes()


def transmission():
    """Thin glass: transmission factor, roughness, colors, and a texture."""
    chart = Chart("Transmission", 4, 3)

    def glass(factor=1.0, roughness=0.0, color=CLEAR, **texture):
        return extended(dielectric(color, roughness), transmission={"transmissionFactor": factor, **texture})

    chart.row(0, [(f"transmission {f}", glass(f, color=(0.8, 0.85, 0.9))) for f in QUARTERS])
    chart.row(1, [(f"transmission, roughness {r}", glass(roughness=r)) for r in (0.1, 0.25, 0.5, 0.8)])
    tints = {"red": (0.9, 0.12, 0.10), "amber": (1.0, 0.60, 0.10), "green": (0.15, 0.75, 0.30)}
    pattern = chart.texture("transmission", patterns.data(patterns.checks()))
    chart.row(2, [(f"transmission, {name}", glass(color=tint)) for name, tint in tints.items()]
              + [("transmission texture", glass(transmissionTexture=pattern, color=(0.8, 0.8, 0.75)))])
    chart.panel()
    return chart.bytes()


def volume():
    """Solid glass: thickness, attenuation distance, attenuation color, and a thickness texture."""
    chart = Chart("Volume", 4, 3)

    def solid(thickness=2.0, distance=1.0, color=(0.10, 0.55, 0.45), **texture):
        value = {"thicknessFactor": thickness, "attenuationDistance": distance, "attenuationColor": color, **texture}
        return extended(dielectric(CLEAR, 0.0), transmission=OPEN, volume=value)

    chart.row(0, [(f"thickness {t}", solid(t)) for t in (0.0, 0.5, 1.0, 2.0)])
    amber = (0.85, 0.35, 0.08)
    chart.row(1, [(f"attenuation distance {d}", solid(distance=d, color=amber)) for d in (8.0, 3.0, 1.0, 0.3)])
    # Thickness is in object space, so half the size has half the thickness and a paler color.
    chart.put(2, 0, "attenuation blue", solid(color=(0.08, 0.16, 0.85)))
    chart.put(2, 1, "attenuation blue, half the size", solid(color=(0.08, 0.16, 0.85)), scale=[0.5] * 3)
    bands = chart.texture("thickness", patterns.data(0.0, patterns.falling()))
    steps = chart.texture("thickness steps", patterns.data(0.0, patterns.stripes(6)))
    chart.put(2, 2, "thickness texture", solid(color=(0.75, 0.06, 0.12), thicknessTexture=bands))
    chart.put(2, 3, "thickness texture, stripes", solid(color=(0.75, 0.06, 0.12), thicknessTexture=steps))
    chart.panel()
    return chart.bytes()


def dispersion():
    """Dispersion, 20 over the Abbe number: balls and cut stones in front of white lines."""
    chart = Chart("Dispersion", 4, 2)

    def prism(value, index, thickness):
        return extended(dielectric(CLEAR, 0.0), ior={"ior": index}, transmission=OPEN,
                        volume={"thicknessFactor": thickness}, dispersion={"dispersion": value})

    values = {0.0: "none", 0.56: "flint glass, Abbe 36", 2.0: "Abbe 10", 5.0: "Abbe 4"}
    chart.row(0, [(f"dispersion {d}, {name}", prism(d, 1.62, 2.0)) for d, name in values.items()])
    stones = [(f"stone, dispersion {d}", prism(d, 2.42, 1.2)) for d in values]
    chart.row(1, stones, shape=shapes.gem(), rotation=about(0, 50.0))
    chart.panel(grille(), cell=0.15)
    return chart.bytes()


def grille():
    """White lines on black, one cell wide: every fourth column, every eighth row."""
    x, y = np.meshgrid(np.arange(8), np.arange(8))
    line = (x % 4 == 1) | (y == 3)
    return bytes_of(np.repeat(np.where(line, 0.85, 0.05)[..., None], 3, axis=2))


def diffuse_transmission():
    """Diffuse transmission: lanterns with a lamp inside, a sheet and a leaf with a lamp behind."""
    chart = Chart("Diffuse transmission", 4, 2)
    warm = (1.0, 0.78, 0.50)

    def thin(factor, tint, color=(0.75, 0.72, 0.66), **textures):
        value = {"diffuseTransmissionFactor": factor, "diffuseTransmissionColorFactor": tint, **textures}
        return extended({**dielectric(color, 0.9), "doubleSided": True}, diffuse_transmission=value)

    chart.row(0, [(f"lantern, diffuse transmission {f}", thin(f, warm)) for f in QUARTERS])
    sheet, tall = shapes.quad(1.7, 2.0), shapes.quad(2.1, 2.1)
    chart.put(1, 0, "paper", thin(0.8, (0.95, 0.9, 0.8)), sheet)
    chart.put(1, 1, "red silk", thin(0.8, (0.9, 0.06, 0.05), (0.35, 0.02, 0.02)), sheet)
    spots = patterns.dots(3, 3, 0.3, 64, 64)
    mark = chart.texture("watermark", patterns.data(alpha=0.15 + 0.85 * spots))
    chart.put(1, 2, "diffuse transmission texture", thin(1.0, (0.95, 0.9, 0.8), diffuseTransmissionTexture=mark), sheet)
    cover, veins = patterns.leaf()
    base = chart.texture("leaf", patterns.color(veins, (0.04, 0.16, 0.02), (0.20, 0.30, 0.08), alpha=cover))
    through = chart.texture("leaf, light through", patterns.color(
        veins, (0.35, 0.62, 0.04), (0.55, 0.45, 0.10), alpha=1.0 - 0.7 * veins))
    leaf = thin(0.7, CLEAR, CLEAR, diffuseTransmissionTexture=through, diffuseTransmissionColorTexture=through)
    leaf["pbrMetallicRoughness"]["baseColorTexture"] = base
    chart.put(1, 3, "leaf", {**leaf, "alphaMode": "MASK", "alphaCutoff": 0.5}, tall)

    chart.glb.document["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"name": "lamp", "type": "point", "color": [1.0, 0.85, 0.65], "intensity": 2.4, "range": 1.7},
        {"name": "back light", "type": "point", "color": [1.0, 0.95, 0.9], "intensity": 3.5, "range": 4.0},
        {"name": "fill", "type": "directional", "color": [0.7, 0.8, 1.0], "intensity": 0.35},
    ]}}

    def light(index, name, **node):
        chart.add({"name": name, **node, "extensions": {"KHR_lights_punctual": {"light": index}}})

    for column in range(4):
        x, y, _ = chart.place(0, column)
        light(0, f"lamp {column + 1}", translation=numbers([x, y - 0.35, 0.0]))
    for column in range(4):
        x, y, _ = chart.place(1, column)
        light(1, f"back light {column + 1}", translation=numbers([x, y + 0.2, -1.3]))
    light(2, "fill", rotation=about(0, -40.0))
    return chart.bytes()
