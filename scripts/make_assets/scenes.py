"""Scenes other than extension charts: metals by n and k, shapes for the material override, a vase with variants."""

import numpy as np

from . import shapes
from .chart import AZIMUTH_DEG, Chart, about, dielectric, metal, metallic_roughness, numbers
from .glb import Glb

# Complex index of refraction n + ik of evaporated films, from Johnson and Christy 1972, "Optical constants of the noble
# metals", Phys. Rev. B 6, 4370, table I: the rows at 1.88, 2.26 and 2.75 eV, which are 659.5, 548.6 and 450.9 nm, for
# red, green and blue.
METALS = {
    "gold": ((0.14, 0.43, 1.38), (3.697, 2.455, 1.914)),
    "silver": ((0.05, 0.06, 0.04), (4.483, 3.586, 2.657)),
    "copper": ((0.22, 1.02, 1.24), (3.747, 2.577, 2.397)),
}


def reflectance(n, k):
    """Reflectance of a smooth conductor in air at normal incidence: F0 = ((n-1)^2 + k^2) / ((n+1)^2 + k^2)."""
    n, k = np.asarray(n), np.asarray(k)
    return ((n - 1.0) ** 2 + k**2) / ((n + 1.0) ** 2 + k**2)


def metal_grid():
    """Gold, silver, copper; roughness 0.05 to 1. The base color is F0; extras carry n and k for the exact Fresnel."""
    chart = Chart("Metal grid", 7, 3)
    for row, (name, (n, k)) in enumerate(METALS.items()):
        extras = {"specula": {"conductor_n": n, "conductor_k": k}}
        chart.row(row, [(f"{name}, roughness {r:.2f}", metal(reflectance(n, k), r, extras=extras))
                        for r in np.linspace(0.05, 1.0, 7).round(4)])
    return chart.bytes()


def material_override():
    """Sphere, Cube and Cylinder: no textures, but texture coordinates and tangents, so that anisotropy can be set."""
    glb = Glb()
    children = []
    parts = (("Sphere", shapes.sphere(36, 24), [-2.35, 1.0, 0.0], 0.0),
             ("Cube", shapes.rounded_cube(), [0.0, 0.85, 0.0], -28.0),
             ("Cylinder", shapes.cylinder(), [2.25, 1.0, 0.0], 0.0))
    for name, shape, place, turn in parts:
        material = glb.material(name, **dielectric((0.6, 0.6, 0.6), 0.4))
        mesh = glb.mesh(name, glb.primitive(shape, material, compact=True))
        children.append({"name": name, "mesh": mesh, "translation": place, "rotation": about(1, turn)})
    root = {"name": "Material override", "children": [1, 2, 3], "rotation": about(1, AZIMUTH_DEG)}
    glb.document.update(nodes=[root, *children], scenes=[{"name": root["name"], "nodes": [0]}], scene=0)
    return glb.bytes()


def variants():
    """A vase in three variants, which change the materials of its body and its band, but not of its plinth."""
    glb = Glb()
    looks = {
        "Porcelain": (dielectric((0.80, 0.79, 0.74), 0.12), metal(reflectance(*METALS["gold"]), 0.25)),
        "Bronze": (metal((0.52, 0.33, 0.17), 0.45), metallic_roughness((0.10, 0.28, 0.22), 0.3, 0.75)),
        "Lacquer": (dielectric((0.012, 0.012, 0.016), 0.18), dielectric((0.55, 0.02, 0.015), 0.22)),
    }
    bodies, bands = [], []
    for name, (body, ring) in looks.items():
        bodies.append(glb.material(f"{name} body", **numbers(body)))
        bands.append(glb.material(f"{name} band", **numbers(ring)))
    stone = glb.material("plinth", **numbers(dielectric((0.20, 0.20, 0.21), 0.7)))
    only = {"POSITION", "NORMAL"}

    def part(shape, materials):
        primitive = glb.primitive(shape, materials[0], only=only, compact=True)
        if len(materials) > 1:
            mappings = [{"material": material, "variants": [i]} for i, material in enumerate(materials)]
            primitive["extensions"] = {"KHR_materials_variants": {"mappings": mappings}}
        return primitive

    mesh = glb.mesh("Vase", part(shapes.vase(), bodies))
    glb.document["meshes"][mesh]["primitives"].append(part(shapes.band(0.775, 0.86, 0.055), bands))
    stand = glb.mesh("Plinth", part(shapes.plinth(0.8, 0.0, 0.14), [stone]))
    glb.document["extensions"] = {"KHR_materials_variants": {"variants": [{"name": name} for name in looks]}}
    nodes = [{"name": "Vase", "mesh": mesh, "children": [1]}, {"name": "Plinth", "mesh": stand}]
    glb.document.update(nodes=nodes, scenes=[{"name": "Variants", "nodes": [0]}], scene=0)
    return glb.bytes()
