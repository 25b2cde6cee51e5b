"""Small textures, 64 x 32 texels for a ball (its u goes once around): fields of 0..1, packed into channels."""

import numpy as np

from .raster import bytes_of, fractal, normals, smooth, srgb

WIDTH, HEIGHT = 64, 32


def _grid(width=WIDTH, height=HEIGHT):
    return np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)


def stripes(count=8, width=WIDTH, height=HEIGHT):
    """Upright stripes, hard 0 and 1."""
    u, _ = _grid(width, height)
    return (np.floor(u * count * 2) % 2).astype(float)


def checks(columns=16, rows=8, width=WIDTH, height=HEIGHT):
    """A checkerboard of 0 and 1."""
    u, v = _grid(width, height)
    return ((np.floor(u * columns) + np.floor(v * rows)) % 2).astype(float)


def dots(columns=12, rows=6, radius=0.34, width=WIDTH, height=HEIGHT):
    """Round spots of 1 on 0."""
    u, v = _grid(width, height)
    x, y = (u * columns) % 1.0 - 0.5, (v * rows) % 1.0 - 0.5
    return smooth(radius + 0.08, radius - 0.08, np.hypot(x, y))


def falling(width=WIDTH, height=HEIGHT):
    """0 at the top to 1 at the bottom."""
    return _grid(width, height)[1]


def clouds(seed, width=WIDTH, height=HEIGHT):
    """Soft noise that repeats."""
    return fractal((height, width), (4, 8), seed, 3)


def data(red=0.0, green=0.0, blue=0.0, alpha=None):
    """Packs linear channels into pixels. A channel is a field or a number; without alpha there are three."""
    channels = [red, green, blue] + ([] if alpha is None else [alpha])
    return bytes_of(np.stack(np.broadcast_arrays(*(np.asarray(c, float) for c in channels)), axis=2))


def color(field, low, high, alpha=None):
    """sRGB pixels between two linear colors, with optional linear alpha."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    rgb = srgb(low + (high - low) * field[..., None])
    return bytes_of(rgb if alpha is None else np.dstack([rgb, np.broadcast_to(alpha, rgb.shape[:2])]))


def ripples(columns=16, rows=8, slope=0.35):
    """A normal texture of round bumps in rows; `slope` is about its largest inclination."""
    u, v = _grid()
    height = np.sin(2 * np.pi * u * columns / 2) * np.sin(2 * np.pi * v * rows / 2)
    texel = np.full(HEIGHT, 1.0 / (columns * 4)), np.full(HEIGHT, 1.0 / (rows * 4))
    return bytes_of(normals(height * slope / 8, *texel) * 0.5 + 0.5)


def directions(angle_rad, strength=1.0):
    """KHR_materials_anisotropy: direction in red and green (from -1..1), strength in blue."""
    return data(np.cos(angle_rad) * 0.5 + 0.5, np.sin(angle_rad) * 0.5 + 0.5, strength)


def circular(size=64):
    """Directions around the center of a disc, as a lathe leaves them; counterclockwise, v down."""
    u, v = _grid(size, size)
    return directions(np.arctan2(0.5 - v, u - 0.5) + np.pi / 2)


def leaf(size=64):
    """A leaf, tip up: cover and veins, both 0..1."""
    u, v = _grid(size, size)
    x, y = u - 0.5, 1.0 - v
    t = np.clip((y - 0.10) / 0.86, 0.0, 1.0)
    half = 0.40 * np.sin(np.pi * t**0.72) ** 0.9
    cover = smooth(-0.012, 0.012, half - np.abs(x)) * (y > 0.10)
    stalk = smooth(0.024, 0.010, np.abs(x)) * (y < 0.14)
    side = (y - 0.75 * np.abs(x)) * 7.5
    side = np.abs(side - np.floor(side) - 0.5) / 7.5
    veins = np.maximum(smooth(0.020, 0.006, np.abs(x)), 0.75 * smooth(0.014, 0.003, side))
    return np.maximum(cover, stalk), np.clip(veins + stalk, 0.0, 1.0)
