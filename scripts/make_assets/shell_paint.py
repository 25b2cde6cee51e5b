"""The shell's textures. All channels derive from one height field and a few masks, so they match."""

import numpy as np

from .raster import blur, box, bytes_of, fractal, halved, mix, noise, normals, smooth, srgb

SIZE = 1024
DRAWN = 2 * SIZE  # drawn twice as large, then averaged

# Linear colors.
IVORY = np.array([0.60, 0.565, 0.49])
ORANGE = np.array([0.72, 0.165, 0.022])
GRAPHITE = np.array([0.035, 0.038, 0.044])
STEEL = np.array([0.56, 0.57, 0.58])
ANODIZED = np.array([0.86, 0.36, 0.13])
INK = np.array([0.045, 0.045, 0.05])
LAMP = np.array([0.10, 0.78, 1.0])

# Zones of the outside in degrees from the opening's center: from, to, panels a tile, shift in panels.
COLLAR = (38.0, 49.0, 1, 0.0)
DIAL = (49.0, 67.5, 2, 0.0)
LAMPS = (67.5, 74.0, 1, 0.0)
MAIN = (74.0, 111.0, 3, 0.0)
SECOND = (111.0, 137.0, 4, 0.5)
RING = (137.0, 143.0, 1, 0.0)
BACK = (143.0, 167.0, 2, 0.25)
CAP = (167.0, 180.0, 1, 0.0)


class Sheet:
    """The shell's UV sheet in meters: where each row lies on the ball and how large its texels are."""

    def __init__(self, angle, radius, row_length, inside, wall):
        rows = (np.arange(DRAWN) + 0.5) / DRAWN
        self.u = rows[None, :]
        self.angle = angle(rows)  # degrees from the opening's axis
        self.inside = inside(rows)  # rows of the rim, the wall and the inner side
        self.wall = wall(rows)  # rows of the rim and the wall
        self.width = np.maximum(radius(rows) * np.pi, 0.12)  # meters that one tile (half a turn) covers
        self.texel_x = self.width / DRAWN
        self.texel_y = row_length(rows) / DRAWN
        self.along = np.cumsum(self.texel_y)

    def row_of(self, angle):
        """Metres along the sheet where the outside has this angle."""
        outside = ~self.inside
        return np.interp(-angle, -self.angle[outside], self.along[outside])

    def cells(self, count, shift=0.0):
        """Index of the cell and meters from its middle, `count` cells a tile; and half a cell in meters."""
        x = self.u * count + shift
        index = np.floor(x)
        cell = self.width[:, None] / count
        return index.astype(int) % count, (x - index - 0.5) * cell, cell / 2

    def zone(self, zone, gap=0.0045, corner=0.02):
        """Distance inside the zone's panels (meters, negative in the gaps), the panel's index and the zone's rows."""
        start, end, count, shift = zone
        top, bottom = self.row_of(end), self.row_of(start)
        index, x, half = self.cells(count, shift)
        if count == 1:
            x = np.zeros_like(x)
        y = (self.along - (top + bottom) / 2)[:, None]
        rows = (self.angle > start) & (self.angle <= end) & ~self.inside
        return box(x, y, half - gap, (bottom - top) / 2 - gap, corner), index, rows[:, None]


def paint(sheet):
    """Images by name: base color, ORM (occlusion, roughness, metallic), normal, emissive, as uint8."""
    shape = (DRAWN, DRAWN)
    height = np.zeros(shape)
    color = np.broadcast_to(GRAPHITE, shape + (3,)).copy()
    metallic, lamp = np.zeros(shape), np.zeros(shape)
    rough = np.full(shape, 0.62)
    edge = np.full(shape, 1.0)  # meters from the nearest panel edge

    def cover(mask, new_color, new_rough, new_metallic):
        nonlocal color, rough, metallic
        color = mix(color, new_color, mask)
        rough = mix(rough, new_rough, mask)
        metallic = mix(metallic, new_metallic, mask)

    def plate(zone, rise=0.006):
        nonlocal height, edge
        inside, index, rows = sheet.zone(zone)
        body = smooth(-0.001, 0.0015, inside) * rows
        height = height + rise * smooth(-0.0005, 0.006, inside) * rows
        edge = np.where(rows, np.abs(inside), edge)
        return body, index, inside

    def brushed(mask, grain):
        lines = noise(shape, (DRAWN // 3, 6), grain)
        cover(mask, STEEL * (0.92 + 0.12 * lines[..., None]), 0.27 + 0.16 * lines, 1.0)

    for zone, grain in ((COLLAR, 11), (RING, 12), (CAP, 13)):
        brushed(plate(zone)[0], grain)
    painted = np.zeros(shape)
    for zone in (DIAL, MAIN, SECOND, BACK):
        body, index, _ = plate(zone)
        accent = (index == 1) if zone is MAIN else np.zeros_like(index, bool)
        shade = 1.0 - 0.05 * ((index * 7 + 3) % 3)
        cover(body, np.where(accent[..., None], ORANGE, IVORY * shade[..., None]), np.where(accent, 0.30, 0.40), 0.0)
        painted = np.maximum(painted, body)

    height = bolts(sheet, cover, height)
    height = dial(sheet, cover, height)
    height = vents(sheet, cover, height)
    height, lamp = lamps(sheet, cover, height)
    inside = sheet.inside[:, None]
    cover(inside * np.ones(shape), GRAPHITE * 1.4, 0.5, 0.0)
    turned = noise(shape, (DRAWN // 4, 3), 14)  # the rim is turned on a lathe: its grain runs around
    cover(inside & sheet.wall[:, None], ANODIZED * (0.94 + 0.12 * turned[..., None]),
          0.28 + 0.10 * turned, 1.0)
    height, lamp = inner_ring(sheet, height, lamp)

    wear(sheet, cover, edge, painted)
    rough = handled(sheet, rough)
    cavity = np.clip((blur(height, 26) - height) / 0.0075, 0.0, 1.0)
    occlusion = 1.0 - 0.85 * smooth(0.0, 1.0, cavity)
    color = mix(color, color * 0.5, 0.8 * cavity)  # dirt in the cavities
    return textures(sheet, color, occlusion, rough, metallic, height, lamp)


def textures(sheet, color, occlusion, rough, metallic, height, lamp):
    """The drawn fields, averaged to the final size and packed into glTF's channels."""
    normal = halved(normals(height, sheet.texel_x, sheet.texel_y))
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    orm = halved(np.stack([occlusion, rough, metallic], axis=2))
    glow = halved(halved(lamp))[..., None] * LAMP
    return {
        "base color": bytes_of(srgb(halved(color))),
        "occlusion roughness metallic": bytes_of(orm),
        "normal": bytes_of(normal * 0.5 + 0.5),
        "emissive": bytes_of(srgb(glow)),
    }


def bolts(sheet, cover, height):
    """A ring of countersunk screws in the collar."""
    _, x, _ = sheet.cells(9)
    y = (sheet.along - sheet.row_of(44.6))[:, None]
    outside = (~sheet.inside)[:, None]
    r = np.hypot(x, y)
    sink = smooth(0.024, 0.019, r) * outside
    head = smooth(0.0165, 0.0145, r) * outside
    slot = smooth(0.0035, 0.0022, np.minimum(np.abs(x + y), np.abs(x - y)) * 0.707) * smooth(0.011, 0.009, r) * outside
    cover(sink, STEEL * 0.55, 0.5, 1.0)
    cover(head, STEEL * 0.9, 0.32, 1.0)
    return height - 0.005 * sink + 0.006 * head - 0.004 * slot


def dial(sheet, cover, height):
    """Engraved, inked tick marks, as on a lens barrel: the fifth longer, the fifteenth longest."""
    index, x, _ = sheet.cells(90)
    length = np.where(index % 15 == 7, 0.075, np.where(index % 5 == 2, 0.050, 0.028))
    thick = np.where(index % 15 == 7, 0.0050, 0.0030)
    y = sheet.row_of(51.6) - sheet.along[:, None]
    inside = box(x, y - length / 2, thick, length / 2, 0.002) * np.ones_like(x)
    inside = np.where((~sheet.inside)[:, None], inside, -1.0)
    mark = smooth(-0.0008, 0.0008, inside)
    cover(mark, INK, 0.55, 0.0)
    return height - 0.0016 * smooth(-0.001, 0.002, inside)


def vents(sheet, cover, height):
    """Five slots in every second panel of the second row."""
    index, x, _ = sheet.cells(4, 0.5)
    y = (sheet.along - sheet.row_of(124.0))[:, None]
    slot = np.full(np.broadcast_shapes(x.shape, y.shape), -1.0)
    for i in range(-2, 3):
        slot = np.maximum(slot, box(x, y - i * 0.042, 0.15, 0.0095, 0.009))
    slot = np.where((index % 2 == 0) & (~sheet.inside)[:, None], slot, -1.0)
    cover(smooth(-0.001, 0.001, slot), GRAPHITE, 0.7, 0.0)
    return height - 0.010 * smooth(-0.001, 0.007, slot)


def lamps(sheet, cover, height):
    """Lamps in the channel between dial and panels, and a status lamp on each main panel."""
    _, x, half = sheet.cells(10)
    y = (sheet.along - sheet.row_of(70.75))[:, None]
    dash = box(x, y, half - 0.022, 0.0125, 0.012)
    _, x, half = sheet.cells(3)
    y = (sheet.along - sheet.row_of(79.5))[:, None]
    status = box(x - half * 0.62, y, 0.042, 0.0085, 0.008)
    glass = np.where((~sheet.inside)[:, None], np.maximum(dash, status), -1.0)
    body = smooth(-0.001, 0.001, glass)
    cover(body, np.array([0.25, 0.42, 0.46]), 0.12, 0.0)
    frame = smooth(-0.008, -0.003, glass)
    height = height * (1.0 - frame) + 0.0035 * frame + 0.002 * smooth(-0.001, 0.010, glass)
    return height, smooth(-0.0005, 0.006, glass)


def inner_ring(sheet, height, lamp):
    """A line of light on the inner side, behind the opening's wall, which lights the core from all sides."""
    rows = sheet.inside & (sheet.angle > 53.0) & (sheet.angle < 56.5)
    rows = blur(np.repeat(rows[:, None].astype(float), 2, axis=1), 3)[:, :1]
    groove = sheet.inside & (np.floor(sheet.angle / 9.0) != np.floor((sheet.angle + 1.2) / 9.0))
    groove = blur(np.repeat(groove[:, None].astype(float), 2, axis=1), 3)[:, :1]
    return height - 0.004 * groove + 0.002 * rows, np.maximum(lamp, rows)


def wear(sheet, cover, edge, painted):
    """Paint that has chipped along the edges and shows bright steel, with a thin rim of primer."""
    shape = painted.shape
    patches = fractal(shape, (5, 5), 3)
    grain = fractal(shape, (48, 48), 4, 3)
    reach = 0.016 * smooth(0.42, 0.80, patches)
    chip = reach * (0.25 + 1.3 * grain) - edge
    cover(smooth(-0.0025, -0.0012, chip) * painted * smooth(0.0, 0.002, reach), GRAPHITE * 2.5, 0.6, 0.0)
    cover(smooth(-0.0002, 0.0008, chip) * painted, STEEL, 0.36, 1.0)


def handled(sheet, rough):
    """Roughness of an object in use: smears, fine scratches and finger marks."""
    shape = rough.shape
    smear = fractal(shape, (6, 7), 5) - 0.5
    rough = rough + 0.20 * smear
    random = np.random.Generator(np.random.PCG64(6))
    scratches = np.zeros(shape)
    for _ in range(150):
        x, y, angle, length, depth = random.random(5)
        count = int(60 + 420 * length**2)
        t = np.arange(count)
        slope = (angle - 0.5) * 1.6
        columns = (x * DRAWN + t).astype(int) % DRAWN
        rows = np.clip((y * DRAWN * 0.75 + t * slope).astype(int), 0, DRAWN - 2)
        fade = np.sin(np.pi * (t + 0.5) / count) * (0.3 + 0.7 * depth)
        scratches[rows, columns] = np.maximum(scratches[rows, columns], fade)
        scratches[rows + 1, columns] = np.maximum(scratches[rows + 1, columns], fade)
    rough = rough + 0.22 * scratches
    for _ in range(14):  # ridges around a center, under an oval
        x, y, angle, warp, _ = random.random(5)
        rough = finger_mark(sheet, rough, x, 0.28 + 0.42 * y, angle * np.pi, warp)
    return np.clip(rough, 0.08, 0.95)


def finger_mark(sheet, rough, x, y, angle, warp):
    """One finger mark, 8 by 12 centimeters: larger than life, so that it shows."""
    row = int(y * DRAWN)
    reach = 90
    rows = slice(max(row - reach, 0), min(row + reach, DRAWN))
    dx = ((sheet.u - x + 0.5) % 1.0 - 0.5) * sheet.width[rows][:, None]
    dy = (sheet.along[rows] - sheet.along[row])[:, None]
    a, b = dx * np.cos(angle) + dy * np.sin(angle), dy * np.cos(angle) - dx * np.sin(angle)
    oval = smooth(1.0, 0.55, np.hypot(a / 0.042, b / 0.058))
    ridges = 0.5 + 0.5 * np.sin(np.hypot(a * 1.2, b + 0.02 * warp) * (2.0 * np.pi / 0.0085))
    rough = rough.copy()
    rough[rows] += 0.13 * oval * (ridges - 0.35)
    return rough
