"""Surfaces of revolution around +Y, with rounded edges, true normals and no UV seam problem."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Surface:
    """Vertex attributes by glTF name, and counter-clockwise triangles."""

    attributes: dict
    triangles: np.ndarray


@dataclasses.dataclass
class Profile:
    """A curve in the half plane (radius, height): points and unit normals, and the length along it in meters."""

    points: np.ndarray
    normals: np.ndarray

    @property
    def length(self):
        """Distance from the first point to each point."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])


def arc(center, radius, start, end, count, inward=False):
    """Points and normals on a circle; angles in degrees from +height towards +radius."""
    angle = np.radians(np.linspace(start, end, count))
    normal = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    return np.asarray(center) + radius * normal, -normal if inward else normal


def joined(*pieces):
    """Joins pieces (points, normals) that meet to one profile and drops duplicate points."""
    points = np.concatenate([p for p, _ in pieces])
    normals = np.concatenate([n for _, n in pieces])
    keep = np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6])
    return Profile(points[keep], normals[keep])


def rounded(corners, steps=8):
    """A polyline of (radius, height, fillet) with rounded corners. The outside is on the right of its direction."""
    corners = np.asarray(corners, float)
    pieces = []
    for i, (*corner, fillet) in enumerate(corners):
        corner = np.asarray(corner)
        before = _unit(corner - corners[i - 1, :2]) if i > 0 else None
        after = _unit(corners[i + 1, :2] - corner) if i + 1 < len(corners) else None
        if before is None or after is None or fillet == 0.0:
            along = after if before is None else before
            pieces.append((corner[None], _right_of(along)[None]))
            continue
        turn = np.arctan2(before[0] * after[1] - before[1] * after[0], before @ after)
        setback = fillet * np.tan(abs(turn) / 2)
        side = -np.sign(turn) * _right_of(before)
        center = corner - before * setback + side * fillet
        angle = np.linspace(0.0, turn, steps)
        c, s = np.cos(angle), np.sin(angle)
        start = -side
        spoke = np.stack([c * start[0] - s * start[1], s * start[0] + c * start[1]], axis=1)
        pieces.append((center + fillet * spoke, spoke * np.sign(turn)))
    return joined(*pieces)


def _unit(v):
    return v / np.linalg.norm(v)


def _right_of(along):
    return np.array([along[1], -along[0]])


def subdivided(profile, longest):
    """The same curve with no step longer than `longest` meters; inserted normals are interpolated."""
    points, normals = [profile.points[:1]], [profile.normals[:1]]
    for i in range(1, len(profile.points)):
        count = max(1, int(np.ceil(np.linalg.norm(profile.points[i] - profile.points[i - 1]) / longest)))
        t = (np.arange(1, count + 1) / count)[:, None]
        points.append(profile.points[i - 1] * (1 - t) + profile.points[i] * t)
        n = profile.normals[i - 1] * (1 - t) + profile.normals[i] * t
        normals.append(n / np.linalg.norm(n, axis=1, keepdims=True))
    return Profile(np.concatenate(points), np.concatenate(normals))


def revolve(profile, segments, v, u_repeat=1.0):
    """Turns a profile around +Y. `v` is the texture row of each profile point; u runs to `u_repeat` in one turn.

    The texture is not mirrored: seen from the side the normals point to, u runs right and v runs down.
    """
    rows, columns = len(profile.points), segments + 1
    turn = np.linspace(0.0, 2.0 * np.pi, columns)
    sin, cos = np.sin(turn), np.cos(turn)
    sin[-1], cos[-1] = sin[0], cos[0]  # closes the seam bit for bit
    radius, height = profile.points.T
    normal_radius, normal_height = profile.normals.T

    def around(r, h):
        return np.stack([np.outer(r, sin), np.repeat(h[:, None], columns, axis=1), np.outer(r, cos)], axis=2)

    position = around(radius, height).reshape(-1, 3)
    normal = around(normal_radius, normal_height).reshape(-1, 3)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    way = np.diff(profile.points, axis=0)
    # The outside is on the right, so v runs up the surface; u runs against the rotation, so that nothing is mirrored.
    right = (profile.normals[:-1] * np.stack([way[:, 1], -way[:, 0]], axis=1)).sum() > 0
    u = turn / (2.0 * np.pi) * u_repeat
    if right:
        u = u_repeat - u
    uv = np.stack([np.repeat(u[None], rows, axis=0), np.repeat(np.asarray(v)[:, None], columns, axis=1)], axis=2)

    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    first, second = np.stack([a, c, d], axis=2), np.stack([a, d, b], axis=2)
    if right:
        first, second = first[..., ::-1], second[..., ::-1]
    flat = radius < 1e-9  # a quad that touches the axis is one triangle
    triangles = np.concatenate([first[~flat[1:]].reshape(-1, 3), second[~flat[:-1]].reshape(-1, 3)])
    return Surface({"POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv.reshape(-1, 2)}, triangles)


def checked(surface):
    """Returns the surface after checking that its triangles match its normals and its texture is not mirrored."""
    p, n, uv = (surface.attributes[k] for k in ("POSITION", "NORMAL", "TEXCOORD_0"))
    t = surface.triangles
    face = np.cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]])
    assert ((face * n[t].sum(axis=1)).sum(axis=1) > 0).all(), "a triangle is wound against its normals"
    e, f = uv[t[:, 1]] - uv[t[:, 0]], uv[t[:, 2]] - uv[t[:, 0]]
    area = e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]
    assert (area < 0).all(), "the texture is mirrored"  # v runs down, so an upright texture has negative area
    return surface
