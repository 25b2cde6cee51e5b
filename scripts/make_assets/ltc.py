"""Fits linearly transformed cosines (Heitz, Dupuy, Hill & Neubelt 2016) to the specular lobe of shaders/brdf/.

The lobe, as a distribution of l for a fixed v, is g = D V NoL / albedo with GGX, height-correlated Smith and F = 1.
A matrix M^-1 takes it to a cosine, and so a polygonal light to another polygon, whose form factor has a closed form:

           | a 0 b |             det M^-1   (q_z)+        2
    M^-1 = | 0 1 0 |    t(l) =   -------- -------- * ------------    q = M^-1 l
           | c 0 d |                pi      |q|^4     1 + cos beta

The first two factors are the paper's (section 3), in a frame with n = z and v in the half plane y = 0, x > 0. Their
lobe reaches below the horizon if c is not 0, where a surface receives nothing; the last factor compensates for what the
shader clips away there. A cosine lobe cut by a second plane through its center, at an angle beta between the two
normals, keeps (1 + cos beta) / 2; the horizon's normal becomes (-c, 0, a) in the space of the cosine, so
cos beta = a / sqrt(a^2 + c^2). So t integrates to 1, and a light that fills the sky gives exactly the albedo.

Table: SIZE x SIZE texels of (a, b, c, d), half floats; column i is roughness i / (SIZE - 1), row j is
sqrt(1 - NoV) = j / (SIZE - 1).
"""

import numpy as np

SIZE = 64
BYTES = SIZE * SIZE * 8
MIN_ALPHA = 0.0025    # as in shaders/brdf/surface.glsl
MIN_N_DOT_V = 1e-4    # as in shaders/brdf/visibility.glsl

LANES = 8             # columns fitted side by side: few enough for the cache
GRID = (24, 20)       # directions per technique, azimuth x polar
WIDER = 3.0           # alpha of the second technique, relative to the lobe's
FLOOR = 0.05          # see `fit`


def alpha_from_roughness(roughness):
    return np.maximum(np.square(roughness), MIN_ALPHA)


def d_ggx(n_dot_h, alpha):
    """Walter et al. 2007, eq. 33."""
    a2 = alpha * alpha
    return a2 / (np.pi * (n_dot_h * n_dot_h * (a2 - 1.0) + 1.0) ** 2)


def smith_root(c, alpha):
    """c (1 + 2 Lambda(c)), Lambda from Heitz 2014, eq. 72."""
    return np.sqrt(c * c * (1.0 - alpha * alpha) + alpha * alpha)


def half_z(l, v):
    h = l + v
    return h[..., 2] / np.linalg.norm(h, axis=-1)


def lobe(l, v, alpha):
    """D V NoL in 1/sr, F = 1; 0 below the horizon. V: Heitz 2014, eq. 99."""
    n_dot_l, n_dot_v = np.maximum(l[..., 2], 0.0), v[2]
    visibility = 0.5 / (n_dot_v * smith_root(n_dot_l, alpha) + n_dot_l * smith_root(n_dot_v, alpha))
    return d_ggx(half_z(l, v), alpha) * visibility * n_dot_l


def sample_lobe(u1, u2, v, alpha):
    """Mirror directions of visible normals: spherical caps (Dupuy & Benyoub 2023). Some are below the horizon."""
    alpha = np.broadcast_to(alpha, np.broadcast_shapes(np.shape(alpha), u1.shape))
    stretched = np.stack([alpha * v[0], alpha * v[1], np.broadcast_to(v[2], alpha.shape)], -1)
    stretched /= np.linalg.norm(stretched, axis=-1, keepdims=True)
    z = (1.0 - u2) * (1.0 + stretched[..., 2]) - stretched[..., 2]
    s = np.sqrt(np.maximum(1.0 - z * z, 0.0))
    h = np.stack([s * np.cos(2.0 * np.pi * u1), s * np.sin(2.0 * np.pi * u1), z], -1) + stretched
    h[..., :2] *= alpha[..., None]
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    return 2.0 * np.sum(h * v, -1, keepdims=True) * h - v


def density(l, v, alpha):
    """The density of `sample_lobe`, per steradian (Heitz 2018, eq. 3 and 17)."""
    return d_ggx(half_z(l, v), alpha) / (2.0 * (v[2] + smith_root(v[2], alpha)))


def directions(n_dot_v, alpha):
    """Directions l (lanes, n, 3), solid angles w (lanes, n), and the normalized lobe g there.

    A third each follows the lobe, a wider lobe, and a uniform distribution, so that they cover both core and tail; w is
    one over the sum of their densities. Everything is even in y, so only y > 0 is sampled, and counts twice.
    """
    v = np.array([np.sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v])
    u1, u2 = np.meshgrid((np.arange(GRID[0]) + 0.5) / (2 * GRID[0]), (np.arange(GRID[1]) + 0.5) / GRID[1])
    u1, u2, alpha = u1.reshape(1, -1), u2.reshape(1, -1), alpha[:, None]
    wide = np.minimum(WIDER * alpha, 1.0)
    s = np.sqrt(1.0 - u2 * u2)
    even = np.stack([s * np.cos(2.0 * np.pi * u1), s * np.sin(2.0 * np.pi * u1), u2], -1)
    l = np.concatenate([sample_lobe(u1, u2, v, alpha), sample_lobe(u1, u2, v, wide),
                        np.broadcast_to(even, (len(alpha),) + even.shape[1:])], 1)
    w = (l[..., 2] > 0.0) / (u1.size * (density(l, v, alpha) + density(l, v, wide) + 0.5 / np.pi))
    g = lobe(l, v, alpha)
    return l, w, g / np.sum(w * g, 1, keepdims=True)


def matrix(p):
    """(..., 4) parameters (ln k, s, ln e, phi) to (a, b, c, d). Any matrix of positive determinant is the triangle
    | k s | times a rotation by phi, which turns the lobe's axis to z; so the fit never meets a singular one.
    | 0 e |"""
    k, s, e = np.exp(p[..., 0]), p[..., 1], np.exp(p[..., 2])
    cos, sin = np.cos(p[..., 3]), np.sin(p[..., 3])
    return np.stack([k * cos - s * sin, k * sin + s * cos, -e * sin, e * cos], -1)


def log_above_horizon(p):
    """ln((1 + cos beta) / 2)."""
    m = matrix(p)
    return np.log(0.5 + 0.5 * m[..., 0] / np.hypot(m[..., 0], m[..., 2]))


def cosine(p, l):
    """t(l) (lanes, n), and its derivatives by the four parameters (4, lanes, n)."""
    k, s, e = np.exp(p[:, 0:1]), p[:, 1:2], np.exp(p[:, 2:3])
    cos, sin = np.cos(p[:, 3:4]), np.sin(p[:, 3:4])
    across, along = cos * l[..., 0] + sin * l[..., 2], cos * l[..., 2] - sin * l[..., 0]
    x, z = k * across + s * along, e * along
    inverse = 1.0 / (x * x + l[..., 1] ** 2 + z * z)
    scale = (z > 0.0) * np.exp(-log_above_horizon(p))[:, None] * k * e / np.pi * inverse * inverse
    t = scale * z
    shrink = 4.0 * t * inverse    # -d(t) / d(|q|^2 / 2) at fixed z
    step = 1e-6 * np.eye(4)
    horizon = np.stack([log_above_horizon(p - h) - log_above_horizon(p + h) for h in step]) / 2e-6
    slope = np.stack([
        t - shrink * x * k * across,
        -shrink * x * along,
        2.0 * t - shrink * z * z,
        -scale * e * across - shrink * (x * (k * along - s * across) - z * e * across),
    ])
    return t, slope + t * horizon[:, :, None]


def fit(p, l, w, g, free):
    """Levenberg-Marquardt from `p` on the parameters `free` for the least sum of w (g - t)^2 / (g / max g + FLOOR),
    among those with a, d > 0; the others would turn the lobe's peak below the surface.

    A plain square would fit only the core and ignore the tail, the glow around a highlight. Divided by g
    (Pearson's chi squared), each part counts by its share of the light. FLOOR limits the weight of very dark parts.
    """
    weight = w / (g / g.max(1, keepdims=True) + FLOOR)
    damping = np.full(len(p), 1e-2)
    t, slope = cosine(p, l)
    error = np.sum(weight * (g - t) ** 2, 1)
    for _ in range(60):
        j = slope[free]
        weighted = j * weight
        normal = np.einsum("ibn,jbn->bij", weighted, j)
        gradient = np.einsum("ibn,bn->bi", weighted, g - t)
        diagonal = np.einsum("bii->bi", normal)
        normal = normal + (diagonal * damping[:, None] + 1e-12 * diagonal.max(1, keepdims=True))[:, :, None] * np.eye(
            len(free))
        trial = p.copy()
        trial[:, free] += np.clip(np.linalg.solve(normal, gradient[..., None])[..., 0], -0.5, 0.5)
        t_trial, slope_trial = cosine(trial, l)
        error_trial = np.sum(weight * (g - t_trial) ** 2, 1)
        better = (error_trial < error) & (matrix(trial)[:, [0, 3]].min(1) > 0.0)
        done = np.where(better, error - error_trial < 1e-6 * error, damping > 1e4)
        p = np.where(better[:, None], trial, p)
        t = np.where(better[:, None], t_trial, t)
        slope = np.where(better[None, :, None], slope_trial, slope)
        error = np.where(better, error_trial, error)
        damping = np.clip(np.where(better, damping / 5.0, damping * 5.0), 1e-9, 1e9)
        if done.all():
            break
    return p


def fit_columns(alpha):
    """Fits all angles for a few alphas: (SIZE, lanes, 4) of (a, b, c, d). Each row starts from the previous one."""
    rows = np.zeros((SIZE, len(alpha), 4))
    p = np.stack([0.0 * alpha, 0.0 * alpha, np.log(alpha), 0.0 * alpha], 1)
    tilt = 0.0 * alpha
    for j, y in enumerate(np.linspace(0.0, 1.0, SIZE)):
        l, w, g = directions(max(1.0 - y * y, MIN_N_DOT_V), alpha)
        if j == 0:    # at normal incidence the lobe is isotropic: a = 1 and b = c = 0
            p = fit(p, l, w, g, [2])
        else:         # a lobe narrower than a row's step would be lost: turn with where most of it is
            center = np.sum((w * g * g)[..., None] * l, 1)
            p[:, 3] -= tilt
            tilt = np.arctan2(-center[:, 0], center[:, 2])
            p[:, 3] += tilt
            p = fit(p, l, w, g, [0, 1, 2, 3])
        rows[j] = matrix(p)
    return rows


def fit_table(progress=lambda done: None):
    """(SIZE, SIZE, 4): rows of sqrt(1 - NoV), columns of roughness."""
    alpha, column = np.unique(alpha_from_roughness(np.linspace(0.0, 1.0, SIZE)), return_inverse=True)
    parts = []
    for first in range(0, len(alpha), LANES):
        parts.append(fit_columns(alpha[first:first + LANES]))
        progress(min(first + LANES, len(alpha)) / len(alpha))
    return np.concatenate(parts, 1)[:, column]


def encode(table):
    return np.ascontiguousarray(table, dtype="<f2").tobytes()


def decode(data):
    return np.frombuffer(data, dtype="<f2").reshape(SIZE, SIZE, 4).astype(np.float32)
