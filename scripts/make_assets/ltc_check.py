"""Measures the error of the table from ltc.py: random rectangles, against a sum over directions.

`integrate_rect` is shaders/lighting/area.glsl in numpy, line by line and in float precision. So the error includes the
matrix, the half floats, the interpolation between texels, the clipping and the rounding.
"""

import numpy as np

from . import ltc

SURFACES = 160        # pairs of roughness and angle
RECTANGLES = 16       # per surface
TRUTH_GRID = 448      # the reference sums over its square of directions
NOTABLE = 0.05        # relative errors count only if the reference, 0..1, is larger than this


def fetch(texels, roughness, n_dot_v):
    """The sampler: bilinear, clamped, texel centers at the ends of the range."""
    x = np.clip([roughness, np.sqrt(1.0 - n_dot_v)], 0.0, 1.0) * (ltc.SIZE - 1)
    (i, j), (fx, fy) = np.minimum(x.astype(int), ltc.SIZE - 2), x - np.minimum(x.astype(int), ltc.SIZE - 2)
    low, high = (texels[k, i] * (1.0 - fx) + texels[k, i + 1] * fx for k in (j, j + 1))
    return (low * (1.0 - fy) + high * fy).astype(np.float32)


def edge_form_factor(a, b):
    across = np.cross(a, b - a)
    size = np.maximum(np.linalg.norm(across, axis=-1), np.float32(1e-18))
    return np.arctan2(size, np.sum(a * b, -1)) * (across[:, 2] / size)


def clip_edge(a, b, rim):
    """Clipped a and b, (0, 0) where nothing is left; `rim` (leave, enter) is written."""
    up_a, up_b = a[:, 2] > 0.0, b[:, 2] > 0.0
    crosses = up_a != up_b
    fall = np.where(crosses, a[:, 2] - b[:, 2], np.float32(1.0))
    on = a + (b - a) * (a[:, 2] / fall)[:, None]
    on[:, 2] = 0.0
    leaves, enters = (crosses & up_a)[:, None], (crosses & up_b)[:, None]
    rim[0][:] = np.where(leaves, on, rim[0])
    rim[1][:] = np.where(enters, on, rim[1])
    gone = ~(up_a | up_b)[:, None]
    return np.where(gone, 0.0, np.where(enters, on, a)), np.where(gone, 0.0, np.where(leaves, on, b))


def integrate_rect(texels, roughness, n_dot_v, center, half_x, half_y, facing):
    """Diffuse and specular factors of many rectangles, (n, 3) each, around the origin; n = z, v in x > 0, y = 0."""
    f = np.float32
    center, half_x, half_y = f(center), f(half_x), f(half_y)
    a, b, c, d = fetch(texels, roughness, max(n_dot_v, ltc.MIN_N_DOT_V))
    m = np.array([[a, 0, b], [0, 1, 0], [c, 0, d]], f).T
    size = np.sum(center**2 + half_x**2 + half_y**2, -1, keepdims=True)
    center, x, y = (t / np.sqrt(size) for t in (center, half_x, half_y))
    horizon, rim = np.zeros((2,) + center.shape, f), np.zeros((2,) + center.shape, f)
    diffuse = specular = 0.0
    for edge in range(5):
        start = center + x + y
        x, y = y, -x
        end = center + x + y
        start, end = clip_edge(start, end, horizon) if edge < 4 else horizon
        diffuse = diffuse + edge_form_factor(start, end)
        specular = specular + edge_form_factor(*clip_edge(start @ m, end @ m, rim))
    specular = specular + edge_form_factor(*rim)
    above = f(0.5) + f(0.5) * a / np.hypot(a, c)
    lit = (np.sum(center * facing, -1) < 0.0) / (2.0 * np.pi)
    return np.minimum(np.abs(diffuse) * lit, 1.0), np.minimum(np.abs(specular) * lit / above, 1.0)


def truth(n_dot_v, alpha):
    """Directions (n, 3) distributed like the lobe, and the fraction of the lobe that each represents."""
    v = np.array([np.sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v])
    u = (np.arange(TRUTH_GRID) + 0.5) / TRUTH_GRID
    u1, u2 = (t.ravel() for t in np.meshgrid(u, u))
    l = ltc.sample_lobe(u1, u2, v, np.float64(alpha))
    w = np.where(l[:, 2] > 0.0, ltc.lobe(l, v, alpha) / ltc.density(l, v, alpha), 0.0)
    return l, w / w.sum()


def hits(l, center, half_x, half_y, facing):
    """Which directions hit the front of one rectangle."""
    slope = l @ facing
    with np.errstate(divide="ignore", invalid="ignore"):
        p = l * ((center @ facing) / slope)[:, None] - center
        inside = (np.abs(p @ half_x) <= half_x @ half_x) & (np.abs(p @ half_y) <= half_y @ half_y)
    return (slope < 0.0) & (center @ facing < 0.0) & inside


def unit(t):
    return t / np.linalg.norm(t, axis=-1, keepdims=True)


def rectangles(random, v, count):
    """Half of them near the mirror direction, half anywhere, also through the horizon; a distance of 1, sides 0.1-4."""
    near = np.array([-v[0], 0.0, v[2]]) + 0.3 * random.normal(size=(count, 3))
    anywhere = random.normal(size=(count, 3))
    anywhere[:, 2] = np.abs(anywhere[:, 2]) - 0.3
    center = unit(np.where(np.arange(count)[:, None] % 2, near, anywhere))
    facing = unit(0.4 * random.normal(size=(count, 3)) - center)
    facing = np.where(np.sum(facing * center, -1, keepdims=True) < -0.1, facing, -center)
    across = unit(np.cross(facing, random.normal(size=(count, 3))))
    half = np.exp(random.uniform(np.log(0.05), np.log(2.0), (2, count, 1)))
    return center, half[0] * across, half[1] * np.cross(facing, across), facing


def compare(texels, surfaces=SURFACES, seed=1):
    """Rows of (roughness, NoV, true, ours)."""
    random = np.random.Generator(np.random.PCG64(seed))
    rows = []
    for roughness, angle in random.random((surfaces, 2)) * [1.0, 0.99 * np.pi / 2.0]:
        n_dot_v = np.cos(angle)
        l, w = truth(n_dot_v, ltc.alpha_from_roughness(roughness))
        rects = rectangles(random, [np.sin(angle), 0.0, n_dot_v], RECTANGLES)
        _, ours = integrate_rect(texels, roughness, n_dot_v, *rects)
        rows += [(roughness, n_dot_v, w[hits(l, *one)].sum(), value) for value, *one in zip(ours, *rects)]
    return np.array(rows)


def report(texels):
    """Prints the errors by angle."""
    rows = compare(texels)
    error = np.abs(rows[:, 3] - rows[:, 2])
    relative = error / np.maximum(rows[:, 2], NOTABLE)
    angle = np.degrees(np.arccos(rows[:, 1]))
    print(f"{len(rows)} rectangles; error of the lobe's part inside (0..1), and relative to it where it is > {NOTABLE}")
    print("view angle     rectangles    mean     95 %      max   relative: mean     95 %      max")
    for low, high in ((0, 90), (0, 30), (30, 60), (60, 75), (75, 85), (85, 90)):
        here = (angle >= low) & (angle < high)
        e, r = error[here], relative[here & (rows[:, 2] > NOTABLE)]
        print(f"{low:3} .. {high:2} deg {here.sum():13}  {e.mean():7.4f}  {np.quantile(e, 0.95):7.4f}  {e.max():7.4f}"
              f"        {r.mean():7.4f}  {np.quantile(r, 0.95):7.4f}  {r.max():7.4f}")
