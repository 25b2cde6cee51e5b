"""The default scene: a ball with an opening that shows its core, on a stand. 2 m tall, on y = 0, +Y up, front to +Z."""

import numpy as np

from . import geometry, shell_paint
from .glb import Glb
from .raster import bytes_of, noise, normals

CENTER = np.array([0.0, 1.16, 0.0])
OUTER, INNER, CORE = 0.82, 0.69, 0.50
OPENING = 38.0  # degrees from the axis to the rim
FILLET = 0.022
AXIS_AZIMUTH, AXIS_ELEVATION = -13.0, 19.0  # direction of the opening, degrees; the default camera is at 30, 15
INNER_SHARE = 0.28  # texture rows given to the hidden inner side, as a share of its length


def shell_profile():
    """The shell around its opening's axis (+Y here), back to rim to inside; and where the rim begins."""
    out = np.degrees(np.arcsin(FILLET / (OUTER - FILLET)))
    into = np.degrees(np.arcsin(FILLET / (INNER + FILLET)))

    def on(radius, angle):
        return radius * np.array([np.sin(np.radians(angle)), np.cos(np.radians(angle))])

    wall = OPENING - 90.0  # the wall's normal: perpendicular to the radius, towards the axis
    outside = geometry.arc((0, 0), OUTER, 180.0, OPENING + out, 97)
    rim = geometry.arc(on(OUTER - FILLET, OPENING + out), FILLET, OPENING + out, wall, 10)
    lip = geometry.arc(on(INNER + FILLET, OPENING + into), FILLET, wall, OPENING + into - 180.0, 10)
    inside = geometry.arc((0, 0), INNER, OPENING + into, 180.0, 49, inward=True)
    outside[0][0, 0] = inside[0][-1, 0] = 0.0  # the poles lie on the axis
    return geometry.joined(outside, rim, lip, inside), len(outside[0])


def shell():
    """The shell's surface and its sheet to paint on. The texture covers half a turn and repeats."""
    profile, rim = shell_profile()
    length = profile.length
    share = length.copy()
    inner_start = rim + 18
    share[inner_start:] = length[inner_start] + (length[inner_start:] - length[inner_start]) * INNER_SHARE
    v = share / share[-1]
    angle = np.degrees(np.arctan2(profile.points[:, 0], profile.points[:, 1]))

    def along(values):
        return lambda rows: np.interp(rows, v, values)

    sheet = shell_paint.Sheet(along(angle), along(profile.points[:, 0]), along(np.gradient(length, v)),
                              inside=lambda rows: rows > v[rim - 1],
                              wall=lambda rows: (rows > v[rim - 1]) & (rows < v[inner_start]))
    return geometry.revolve(profile, 168, v, u_repeat=2.0), sheet, v, profile


def open_sky(points, normals_, solid, reach, seed):
    """Fraction of the sky visible from points of a profile, by cosine-weighted rays; `solid(p)` is the occluder."""
    random = np.random.Generator(np.random.PCG64(seed)).random((256, 2))
    r, phi = np.sqrt(random[:, 0]), 2.0 * np.pi * random[:, 1]
    local = np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1.0 - random[:, 0])], axis=1)
    steps = np.linspace(0.02, reach, 48)
    seen = np.empty(len(points))
    for i, ((radius, height), (nr, nh)) in enumerate(zip(points, normals_)):
        n, t, b = np.array([nr, nh, 0.0]), np.array([-nh, nr, 0.0]), np.array([0.0, 0.0, 1.0])
        rays = local @ np.stack([t, b, n])
        p = np.array([radius, height, 0.0]) + 0.004 * n + steps[:, None, None] * rays
        seen[i] = 1.0 - solid(p).any(axis=0).mean()
    return seen


def shell_sky(v, profile):
    """Occlusion of each texture row by the shell and the core, for the whole ball's shape rather than its grooves."""

    def solid(p):
        distance = np.linalg.norm(p, axis=-1)
        behind_rim = p[..., 1] < distance * np.cos(np.radians(OPENING))
        return ((distance < OUTER) & (distance > INNER) & behind_rim) | (distance < CORE)

    rows = (np.arange(shell_paint.SIZE) + 0.5) / shell_paint.SIZE
    return np.interp(rows, v, open_sky(profile.points, profile.normals, solid, 1.6, 21))


def core():
    """The core: a smooth ball whose vertex colors run from gold at the opening to copper and plum behind."""
    profile = geometry.joined(geometry.arc((0, 0), CORE, 180.0, 0.0, 57))
    profile.points[[0, -1], 0] = 0.0
    surface = geometry.revolve(profile, 96, profile.length / profile.length[-1])
    y = surface.attributes["NORMAL"][:, 1]
    stops = np.array([-1.0, 0.1, 0.55, 0.8, 1.0])
    colors = np.array(
        [[0.30, 0.10, 0.22], [0.42, 0.12, 0.20], [0.85, 0.30, 0.16], [0.95, 0.60, 0.22], [0.98, 0.74, 0.36]])
    color = np.stack([np.interp(y, stops, colors[:, i]) for i in range(3)], axis=1)
    surface.attributes["COLOR_0"] = color
    return surface


def stand():
    """Foot, neck and cup. UV set 0 repeats a fine ribbing; set 1 maps the profile once, for the occlusion texture."""
    corners = [
        (0.0, 0.0, 0.0), (0.62, 0.0, 0.012), (0.64, 0.07, 0.03), (0.58, 0.105, 0.02), (0.40, 0.125, 0.05),
        (0.25, 0.20, 0.05), (0.235, 0.30, 0.03), (0.30, 0.34, 0.03), (0.47, 0.37, 0.02), (0.505, 0.45, 0.02),
        (0.495, 0.53, 0.012), (0.46, 0.535, 0.010), (0.44, 0.50, 0.0),
    ]
    profile = geometry.subdivided(geometry.rounded(corners, steps=6), 0.06)
    length = profile.length
    surface = geometry.revolve(profile, 112, length / 0.16, u_repeat=24.0)
    once = geometry.revolve(profile, 112, length / length[-1])
    surface.attributes["TEXCOORD_1"] = once.attributes["TEXCOORD_0"]
    return surface, profile


def stand_textures(profile):
    """The ribbing's normal map, and the occlusion by the ball, the ground and the stand itself."""
    size = 128
    x = (np.arange(size) + 0.5) / size
    rib = 0.0016 * (0.5 + 0.5 * np.cos(2.0 * np.pi * 4.0 * x))[:, None]
    height = rib + 0.0006 * noise((size, size), (32, 32), 31)
    texel = np.full(3 * size, 0.16 / size)
    tiled = normals(np.concatenate([height] * 3), texel, texel)[size:-size]  # three, so that the middle one repeats
    ribbing = bytes_of(tiled * 0.5 + 0.5)

    outline_r, outline_y = profile.points[:, 0], profile.points[:, 1]

    def solid(p):
        ball = ((p - np.array([0.0, CENTER[1], 0.0])) ** 2).sum(axis=-1) < OUTER**2
        ring = np.hypot(p[..., 0], p[..., 2])
        inside = (ring < np.interp(p[..., 1], outline_y[2:-12], outline_r[2:-12])) & (p[..., 1] < 0.53)
        return ball | inside | (p[..., 1] < 0.0)

    seen = open_sky(profile.points, profile.normals, solid, 1.2, 22)
    rows = np.interp(x, profile.length / profile.length[-1], seen)
    occlusion = np.repeat(np.repeat(bytes_of(0.15 + 0.85 * rows)[:, None], 16, axis=1)[..., None], 3, axis=2)
    return ribbing, occlusion


def facing():
    """Quaternion that rotates +Y to the direction of the opening."""
    azimuth, tilt = np.radians(AXIS_AZIMUTH) / 2, np.radians(90.0 - AXIS_ELEVATION) / 2
    # First tilt +Y towards +Z (around +X), then rotate around +Y.
    y, w, x, k = np.sin(azimuth), np.cos(azimuth), np.sin(tilt), np.cos(tilt)
    return [float(q) for q in (w * x, y * k, -y * x, w * k)]


def build():
    """The .glb's bytes."""
    glb = Glb()
    surface, sheet, v, profile = shell()
    images = shell_paint.paint(sheet)
    sky = shell_sky(v, profile)
    orm = images["occlusion roughness metallic"]
    orm[..., 0] = bytes_of(orm[..., 0] / 255.0 * sky[:, None])
    texture = {name: glb.texture(f"shell {name}", pixels) for name, pixels in images.items()}
    shell_material = glb.material(
        "shell: worn paint on steel",
        pbrMetallicRoughness={
            "baseColorTexture": {"index": texture["base color"]},
            "metallicRoughnessTexture": {"index": texture["occlusion roughness metallic"]},
        },
        normalTexture={"index": texture["normal"]},
        occlusionTexture={"index": texture["occlusion roughness metallic"]},
        emissiveTexture={"index": texture["emissive"]},
        emissiveFactor=[1.0, 1.0, 1.0],
        extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 1.6}},
    )
    glb.document["extensionsUsed"] = ["KHR_materials_emissive_strength"]
    core_material = glb.material(
        "core: tinted metal", pbrMetallicRoughness={"metallicFactor": 1.0, "roughnessFactor": 0.38})
    stand_surface, stand_profile = stand()
    ribbing, occlusion = stand_textures(stand_profile)
    stand_material = glb.material(
        "stand: ribbed rubber",
        pbrMetallicRoughness={
            "baseColorFactor": [0.075, 0.085, 0.105, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.48},
        normalTexture={"index": glb.texture("stand ribbing", ribbing)},
        occlusionTexture={"index": glb.texture("stand occlusion", occlusion), "texCoord": 1},
    )
    turned = {"translation": CENTER.tolist(), "rotation": facing()}
    parts = [("Shell", surface, shell_material, turned), ("Core", core(), core_material, turned),
             ("Stand", stand_surface, stand_material, {})]
    nodes = [{"name": "Shader ball", "children": [1, 2, 3]}]
    for name, part, material, placed in parts:
        mesh = glb.mesh(name, glb.primitive(geometry.checked(part), material))
        nodes.append({"name": name, "mesh": mesh, **placed})
    glb.document.update(nodes=nodes, scenes=[{"name": "Shader ball", "nodes": [0]}], scene=0)
    return glb.bytes()
