"""Charts of the extensions that change reflection: from off to full strength, then with textures."""

import numpy as np

from . import patterns, shapes
from .chart import Chart, dielectric, extended, metal, metallic_roughness

QUARTERS = (0.0, 0.33, 0.67, 1.0)


def clearcoat():
    """Lacquer over a rough red metallic paint: its factor, its roughness, its textures."""
    chart = Chart("Clearcoat", 4, 3)
    paint = metallic_roughness((0.45, 0.02, 0.025), 0.8, 0.5)

    def coat(factor, roughness=0.0, **textures):
        return {"clearcoatFactor": factor, "clearcoatRoughnessFactor": roughness, **textures}

    chart.row(0, [(f"clearcoat {f}", extended(paint, clearcoat=coat(f))) for f in QUARTERS])
    chart.row(1, [(f"clearcoat roughness {r}", extended(paint, clearcoat=coat(1.0, r))) for r in (0.1, 0.2, 0.4, 0.7)])
    ripples = chart.texture("ripples", patterns.ripples())
    packed = chart.texture("clearcoat, roughness", patterns.data(patterns.stripes(), 0.7 * patterns.falling()))
    chart.row(2, [
        ("clearcoat texture", extended(paint, clearcoat=coat(1.0, clearcoatTexture=packed))),
        ("clearcoat roughness texture", extended(paint, clearcoat=coat(1.0, 1.0, clearcoatRoughnessTexture=packed))),
        ("clearcoat normal texture", extended(paint, clearcoat=coat(1.0, clearcoatNormalTexture=ripples))),
        ("smooth clearcoat on a bumpy base", extended({**paint, "normalTexture": ripples}, clearcoat=coat(1.0))),
    ], tangents=True)
    return chart.bytes()


def anisotropy():
    """Brushed metal: strength, direction, and both from a texture."""
    chart = Chart("Anisotropy", 4, 3, shapes.sphere(36, 24))  # fewer vertices, as tangents are large
    steel = metal((0.72, 0.70, 0.68), 0.35)

    def brushed(strength, degrees=0.0, **texture):
        value = {"anisotropyStrength": strength, "anisotropyRotation": np.radians(degrees), **texture}
        return extended(steel, anisotropy=value)

    def textured(name, pixels, strength=1.0):
        return brushed(strength, anisotropyTexture=chart.texture(name, pixels))

    chart.row(0, [(f"anisotropy {s}", brushed(s)) for s in QUARTERS], tangents=True)
    chart.row(1, [(f"anisotropy direction {d} degrees", brushed(0.9, d)) for d in (0, 45, 90, 135)], tangents=True)
    weave = patterns.directions(patterns.checks() * np.pi / 2)
    stripes = patterns.directions(0.0, patterns.stripes())
    chart.row(2, [("anisotropy direction texture", textured("directions", weave)),
                  ("anisotropy strength texture", textured("strengths", stripes))], tangents=True)
    circular = textured("circular", patterns.circular(), 0.9)
    chart.put(2, 2, "anisotropy around a disc", circular, shapes.disc(), tangents=True)
    chart.put(2, 3, "anisotropy of a lathe", brushed(0.9), shapes.cylinder(), tangents=True, scale=[0.9] * 3)
    return chart.bytes()


def sheen():
    """Cloth: color and roughness of its fibers, and their textures."""
    chart = Chart("Sheen", 4, 3)
    cloth = dielectric((0.06, 0.01, 0.09), 0.9)

    def fibers(color, roughness, base=cloth, **textures):
        return extended(base, sheen={"sheenColorFactor": color, "sheenRoughnessFactor": roughness, **textures})

    chart.row(0, [(f"sheen {s}", fibers([s] * 3, 0.4)) for s in QUARTERS])
    chart.row(1, [(f"sheen roughness {r}", fibers([1.0] * 3, r)) for r in (0.15, 0.3, 0.6, 1.0)])
    spots = chart.texture("sheen color, roughness", patterns.color(
        patterns.dots(), (0.02, 0.05, 0.30), (1.0, 0.55, 0.10), alpha=0.15 + 0.85 * patterns.stripes()))
    chart.row(2, [
        ("two-tone satin", fibers([0.10, 0.25, 1.0], 0.3, dielectric((0.40, 0.02, 0.02), 0.8))),
        ("velvet", fibers([0.9, 0.30, 0.45], 0.5, dielectric((0.10, 0.0, 0.015), 1.0))),
        ("sheen color texture", fibers([1.0] * 3, 0.4, sheenColorTexture=spots)),
        ("sheen roughness texture", fibers([1.0, 0.9, 0.8], 1.0, sheenRoughnessTexture=spots)),
    ])
    return chart.bytes()


def specular():
    """Strength and color of a dielectric's reflection, and their textures."""
    chart = Chart("Specular", 4, 3)
    plastic = dielectric((0.03, 0.05, 0.08), 0.22)

    def shiny(base=plastic, ior=None, **value):
        more = {} if ior is None else {"ior": {"ior": ior}}
        return extended(base, specular=value, **more)

    chart.row(0, [(f"specular {s}", shiny(specularFactor=s)) for s in QUARTERS])
    tints = {"gold": (1.0, 0.65, 0.15), "red": (1.0, 0.12, 0.08), "cyan": (0.1, 0.8, 1.0), "bright": (4.0, 4.0, 4.0)}
    chart.row(1, [(f"specular color {name}", shiny(specularColorFactor=tint)) for name, tint in tints.items()])
    picture = chart.texture("specular color, specular", patterns.color(
        patterns.checks(), (0.05, 0.25, 1.0), (1.0, 0.35, 0.05), alpha=patterns.stripes(6)))
    chart.row(2, [
        ("specular texture", shiny(specularTexture=picture)),
        ("specular color texture", shiny(specularColorTexture=picture)),
        ("specular color texture, ior 2", shiny(ior=2.0, specularColorTexture=picture)),
        ("both textures, ior 2", shiny(ior=2.0, specularTexture=picture, specularColorTexture=picture)),
    ])
    return chart.bytes()


def iridescence():
    """A thin film: on black glass, on metal, of several thicknesses and indices, and its textures."""
    chart = Chart("Iridescence", 4, 4)
    black = extended(dielectric((0.01, 0.01, 0.012), 0.12), ior={"ior": 1.8})
    steel = metal((0.56, 0.55, 0.53), 0.2)

    def film(base, factor=1.0, thickness=400.0, ior=1.33, **textures):
        return extended(base, iridescence={"iridescenceFactor": factor, "iridescenceIor": ior,
                                           "iridescenceThicknessMaximum": thickness, **textures})

    def uneven(base, texture, **more):  # the minimum counts only where there is a texture
        return film(base, thickness=900.0, iridescenceThicknessMinimum=150.0, iridescenceThicknessTexture=texture,
                    **more)

    chart.row(0, [(f"iridescence {f} on black glass", film(black, f)) for f in QUARTERS])
    on_metal = ((nm, film(steel, thickness=float(nm), ior=1.6)) for nm in (200, 300, 420, 600))
    chart.row(1, [(f"film of {nm} nm on metal", material) for nm, material in on_metal])
    chart.row(2, [(f"film of index {i} on black glass", film(black, ior=i)) for i in (1.15, 1.33, 1.5, 2.4)])
    picture = chart.texture("iridescence, thickness", patterns.data(patterns.dots(), patterns.falling()))
    swirl = chart.texture("swirls", patterns.data(1.0, patterns.clouds(21)))
    chart.row(3, [
        ("iridescence texture", film(steel, ior=1.6, iridescenceTexture=picture)),
        ("thickness texture on metal", uneven(steel, picture, ior=1.6)),
        ("thickness texture on black glass", uneven(black, picture)),
        ("swirls", uneven(black, swirl)),
    ])
    return chart.bytes()


def specular_glossiness():
    """The older material model, with metallic-roughness for those that cannot read it."""
    chart = Chart("Specular-glossiness", 4, 3)

    def glossy(diffuse, reflected, glossiness, **textures):
        metallic = max(reflected) > 0.2
        base = metal(reflected, 1.0 - glossiness) if metallic else dielectric(diffuse, 1.0 - glossiness)
        if "diffuseTexture" in textures:
            base["pbrMetallicRoughness"]["baseColorTexture"] = textures["diffuseTexture"]
        return extended(base, pbrSpecularGlossiness={
            "diffuseFactor": [*diffuse, 1.0], "specularFactor": reflected, "glossinessFactor": glossiness, **textures})

    green, white, plastic = (0.05, 0.25, 0.12), (1.0, 1.0, 1.0), (0.04, 0.04, 0.04)
    chart.row(0, [(f"glossiness {g}", glossy(green, plastic, g)) for g in (0.0, 0.33, 0.67, 0.95)])
    chart.row(1, [
        ("specular black", glossy(green, (0.0, 0.0, 0.0), 0.8)),
        ("specular 0.16, a gem", glossy(green, (0.16, 0.16, 0.16), 0.8)),
        ("specular gold, diffuse black", glossy((0.0, 0.0, 0.0), (1.0, 0.77, 0.34), 0.7)),
        ("specular copper, diffuse black", glossy((0.0, 0.0, 0.0), (0.95, 0.64, 0.54), 0.7)),
    ])
    checks = patterns.checks()
    diffuse = chart.texture("diffuse", patterns.color(checks, (0.0, 0.0, 0.0), (0.55, 0.06, 0.05)))
    packed = chart.texture("specular, glossiness", patterns.color(
        checks, (0.95, 0.72, 0.35), plastic, alpha=0.35 + 0.55 * patterns.stripes(4)))
    chart.row(2, [
        ("diffuse texture", glossy(white, plastic, 0.7, diffuseTexture=diffuse)),
        ("specular texture", glossy((0.0, 0.0, 0.0), white, 0.7, specularGlossinessTexture=packed)),
        ("both textures", glossy(white, white, 1.0, diffuseTexture=diffuse, specularGlossinessTexture=packed)),
        ("both textures and factors", glossy((0.3, 1.0, 1.0), (0.5, 0.7, 1.0), 0.6, diffuseTexture=diffuse,
                                             specularGlossinessTexture=packed)),
    ])
    return chart.bytes()
