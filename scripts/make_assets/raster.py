"""Painting with numpy arrays: noise that repeats to the right, blurs, distances, and normals from heights."""

import numpy as np


def smooth(low, high, x):
    """0 below `low`, 1 above `high`, smooth between; the bounds may be swapped."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def mix(a, b, t):
    """a where t is 0, b where it is 1; t may lack the color axis."""
    if np.ndim(a) > np.ndim(t) or np.ndim(b) > np.ndim(t):
        t = np.asarray(t)[..., None]
    return a + (b - a) * t


def noise(shape, cells, seed):
    """Smooth noise in 0..1 on (rows, columns) lattice cells; it repeats in both directions."""
    lattice = np.random.Generator(np.random.PCG64(seed)).random(cells)

    def axis(size, count):
        x = (np.arange(size) + 0.5) / size * count
        i = np.floor(x).astype(int)
        f = x - i
        return i % count, (i + 1) % count, f * f * (3.0 - 2.0 * f)

    y0, y1, fy = axis(shape[0], cells[0])
    x0, x1, fx = axis(shape[1], cells[1])
    rows = lattice[:, x0] * (1.0 - fx) + lattice[:, x1] * fx
    return rows[y0] * (1.0 - fy)[:, None] + rows[y1] * fy[:, None]


def fractal(shape, cells, seed, octaves=4):
    """Octaves of noise, each twice as fine and half as strong; about 0..1."""
    total, weight = np.zeros(shape), 0.0
    for i in range(octaves):
        total += noise(shape, (cells[0] << i, cells[1] << i), seed * 16 + i) * 0.5**i
        weight += 0.5**i
    return np.clip((total / weight - 0.5) * 1.6 + 0.5, 0.0, 1.0)


def blur(image, radius):
    """Three box blurs, close to a Gaussian; wraps to the right, holds the first and last row."""
    for _ in range(3):
        for axis, mode in ((0, "edge"), (1, "wrap")):
            pad = [(0, 0), (0, 0)]
            pad[axis] = (radius + 1, radius)
            total = np.cumsum(np.pad(image, pad, mode=mode), axis=axis)
            count = image.shape[axis]
            last, first = np.arange(count) + 2 * radius + 1, np.arange(count)
            image = (total.take(last, axis=axis) - total.take(first, axis=axis)) / (2 * radius + 1)
    return image


def box(x, y, half_x, half_y, corner):
    """Distance inside a rounded rectangle around the origin: positive inside, in the units of x and y."""
    qx, qy = np.abs(x) - (half_x - corner), np.abs(y) - (half_y - corner)
    outside = np.hypot(np.maximum(qx, 0.0), np.maximum(qy, 0.0))
    return corner - outside - np.minimum(np.maximum(qx, qy), 0.0)


def normals(height, texel_x, texel_y):
    """Tangent-space normals of a height field, glTF's way: green is up, so towards the image's first row.

    Height and texel sizes in meters; `texel_x` and `texel_y` hold one number a row.
    """
    dx = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / (2.0 * texel_x[:, None])
    dy = np.gradient(height, axis=0) / texel_y[:, None]
    n = np.stack([-dx, dy, np.ones_like(height)], axis=2)
    return n / np.linalg.norm(n, axis=2, keepdims=True)


def halved(image):
    """Every four texels averaged to one."""
    h, w = image.shape[:2]
    return image.reshape(h // 2, 2, w // 2, 2, *image.shape[2:]).mean(axis=(1, 3))


def bytes_of(image):
    """0..1 to 0..255."""
    return np.clip(np.floor(image * 255.0 + 0.5), 0, 255).astype(np.uint8)


def srgb(linear):
    """Linear to sRGB-encoded."""
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
