"""Meshes that the models share: sphere, cylinder, rounded cube, vase, gem, disc, quad; all with glTF's tangents.

Each is a `geometry.Surface` in meters with POSITION, NORMAL, TEXCOORD_0 and TANGENT; the writer omits attributes that a
material does not use. Tangents point in the direction of u; textures are not mirrored, so their w is 1.
"""

import numpy as np

from . import geometry


def _turned(profile, segments):
    """A profile around +Y, from top to bottom, u = 0.5 at +Z, so that the texture's seam is at the back."""
    surface = geometry.checked(geometry.revolve(profile, segments, profile.length / profile.length[-1]))
    turn = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    around = np.stack([np.cos(turn), np.zeros_like(turn), -np.sin(turn)], axis=1)
    tangent = np.tile(np.concatenate([around, np.ones((segments + 1, 1))], axis=1), (len(profile.points), 1))
    half_turn = np.array([-1.0, 1.0, -1.0])
    for name in ("POSITION", "NORMAL"):
        surface.attributes[name] = surface.attributes[name] * half_turn
    tangent[:, :3] = tangent[:, :3] * half_turn
    surface.attributes["TANGENT"] = tangent
    return surface


def _downwards(profile):
    return geometry.Profile(profile.points[::-1], profile.normals[::-1])


def sphere(segments=48, rings=32):
    """Radius 1, so that positions equal normals and the file stores them once."""
    profile = geometry.joined(geometry.arc((0, 0), 1.0, 0.0, 180.0, rings + 1))
    profile.points[[0, -1], 0] = 0.0
    profile.normals[:] = profile.points
    surface = _turned(profile, segments)
    surface.attributes["NORMAL"] = surface.attributes["POSITION"]
    return surface


def cylinder(radius=0.85, half_height=1.0, fillet=0.12, segments=36):
    """Upright, with rounded edges; its tangents run around the axis, on the caps too, as if turned on a lathe."""
    corners = [(0, -half_height, 0), (radius, -half_height, fillet), (radius, half_height, fillet), (0, half_height, 0)]
    return _turned(_downwards(geometry.rounded(corners, 6)), segments)


def vase(segments=30):
    """A vase with an open neck and a wall: height 2, standing on y = 0."""
    controls = np.array([  # radius, height: up the inner wall, over the lip, down the outer wall to the foot
        (0.0, 0.12), (0.36, 0.16), (0.66, 0.55), (0.70, 0.88), (0.48, 1.28), (0.24, 1.58), (0.25, 1.80), (0.40, 1.97),
        (0.44, 2.00), (0.46, 1.96), (0.32, 1.78), (0.31, 1.60), (0.55, 1.27), (0.78, 0.88), (0.74, 0.52), (0.46, 0.14),
        (0.42, 0.03), (0.38, 0.0), (0.0, 0.0),
    ])
    ends = np.vstack([2 * controls[0] - controls[1], controls, 2 * controls[-1] - controls[-2]])
    points = []
    for i, (a, b, c, d) in enumerate(zip(ends, ends[1:], ends[2:], ends[3:])):  # Catmull-Rom
        steps = 1 if i < 4 else 2 if i < 8 or i > 14 else 4  # finer along the visible outline
        t = (np.arange(steps) / steps)[:, None]
        points.append(b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))))
    points = np.vstack([*points, controls[-1:]])
    points[:, 0] = np.maximum(points[:, 0], 0.0)
    along = np.gradient(points, axis=0)
    normals = np.stack([-along[:, 1], along[:, 0]], axis=1)
    normals[0], normals[-1] = (0.0, 1.0), (0.0, -1.0)  # on the axis
    return _turned(geometry.Profile(points, normals / np.linalg.norm(normals, axis=1, keepdims=True)), segments)


def band(radius, height, half_width, segments=30):
    """A raised ring around +Y, its middle at `height`; open at the back of its section, which the wall hides."""
    points, normals = geometry.arc((0, 0), 1.0, 0.0, 180.0, 9)
    thick = 0.45 * half_width
    normals = normals / np.array([thick, half_width])  # of an ellipse
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = points * np.array([thick, half_width]) + np.array([radius, height])
    return _turned(geometry.Profile(points, normals), segments)


def plinth(radius, top, height, segments=30):
    """A low round stand whose top is at `top`."""
    fillet = 0.3 * height
    corners = [(0, top - height, 0), (radius, top - height, fillet), (radius, top, fillet), (0, top, 0)]
    return _turned(_downwards(geometry.rounded(corners, 5)), segments)


def rounded_cube(half=0.85, fillet=0.16, steps=3):
    """A cube with rounded edges; each face has the whole texture, and its tangents run to the face's right."""
    flat = half - fillet
    angle = np.linspace(0.0, np.pi / 4, steps + 1)
    line = np.concatenate([-flat - fillet * np.tan(angle[::-1]), flat + fillet * np.tan(angle)])
    length = np.concatenate([-flat - fillet * angle[::-1], flat + fillet * angle])  # along the surface
    share = (length - length[0]) / (length[-1] - length[0])
    count = len(line)
    x, y = np.meshgrid(line, -line)  # rows from top to bottom
    on_face = np.stack([x, y, np.full_like(x, half)], axis=2).reshape(-1, 3)
    core = np.clip(on_face, -flat, flat)
    normal = on_face - core
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    position = core + fillet * normal
    tangent = np.array([1.0, 0.0, 0.0]) - normal * normal[:, :1]
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    uv = np.stack(np.meshgrid(share, share), axis=2).reshape(-1, 2)
    corner = np.arange(count * count).reshape(count, count)
    a, b, c, d = (q.reshape(-1) for q in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]))
    face = np.concatenate([np.stack([a, c, d], axis=1), np.stack([a, d, b], axis=1)])

    faces = []  # right, up, out of each
    for right, up in (((1, 0, 0), (0, 1, 0)), ((-1, 0, 0), (0, 1, 0)), ((0, 0, -1), (0, 1, 0)), ((0, 0, 1), (0, 1, 0)),
                      ((1, 0, 0), (0, 0, -1)), ((1, 0, 0), (0, 0, 1))):
        faces.append(np.array([right, up, np.cross(right, up)], float))
    ones = np.ones((len(position), 1))
    return geometry.checked(geometry.Surface({
        "POSITION": np.concatenate([position @ f for f in faces]),
        "NORMAL": np.concatenate([normal @ f for f in faces]),
        "TEXCOORD_0": np.tile(uv, (6, 1)),
        "TANGENT": np.concatenate([np.hstack([tangent @ f, ones]) for f in faces]),
    }, np.concatenate([face + i * len(position) for i in range(6)])))


def quad(width, height, repeat=(1.0, 1.0)):
    """Upright, facing +Z, around the origin."""
    x, y = np.array([-1, 1, -1, 1]) * width / 2, np.array([1, 1, -1, -1]) * height / 2
    uv = np.array([(0, 0), (1, 0), (0, 1), (1, 1)]) * np.asarray(repeat, float)
    return _flat(np.stack([x, y, np.zeros(4)], axis=1), uv, np.array([(0, 2, 3), (0, 3, 1)]))


def disc(segments=64):
    """Radius 1, facing +Z, with a plane projection of the texture."""
    turn = np.arange(segments) / segments * 2.0 * np.pi
    rim = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    xy = np.vstack([[(0.0, 0.0)], rim])
    i = np.arange(segments)
    fan = np.stack([np.zeros_like(i), i + 1, (i + 1) % segments + 1], axis=1)
    uv = np.clip(xy * np.array([0.5, -0.5]) + 0.5, 0.0, 1.0)
    return _flat(np.hstack([xy, np.zeros((segments + 1, 1))]), uv, fan)


def _flat(position, uv, triangles):
    count = len(position)
    return geometry.checked(geometry.Surface({
        "POSITION": position,
        "NORMAL": np.tile([0.0, 0.0, 1.0], (count, 1)),
        "TEXCOORD_0": uv,
        "TANGENT": np.tile([1.0, 0.0, 0.0, 1.0], (count, 1)),
    }, triangles))


def gem():
    """A cut stone, girdle radius 1, table up: 8-fold crown, 16 facets below; one normal a facet, no texture."""
    def ring(count, radius, height, offset=0.0):
        turn = (np.arange(count) + offset) / count * 2.0 * np.pi
        return np.stack([radius * np.sin(turn), np.full(count, height), radius * np.cos(turn)], axis=1)

    table, crown, girdle = ring(8, 0.56, 0.36), ring(8, 0.84, 0.21, 0.5), ring(16, 1.0, 0.0)
    top, bottom = np.array([0.0, 0.36, 0.0]), np.array([0.0, -0.92, 0.0])
    facets = []
    for i in range(8):
        j = (i + 1) % 8
        edge, middle, after = girdle[2 * i], girdle[2 * i + 1], girdle[2 * j]
        facets += [(top, table[i], table[j]), (table[i], table[j], crown[i]), (table[i], crown[i], edge),
                   (table[i], crown[i - 1], edge), (crown[i], edge, middle), (crown[i], middle, after),
                   (bottom, edge, middle), (bottom, middle, after)]
    corners = np.array(facets)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = (normal * corners.mean(axis=1)).sum(axis=1) < 0.0  # the stone is convex around the origin
    corners[inwards] = corners[inwards][:, ::-1]
    normal[inwards] *= -1.0
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    position = corners.reshape(-1, 3)
    return geometry.Surface({"POSITION": position, "NORMAL": np.repeat(normal, 3, axis=0)},
                            np.arange(len(position)).reshape(-1, 3))
