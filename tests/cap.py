"""cap.py LIBRARY: the finger in a cap, fitted by LIBRARY's ethd_cap_step and by scipy.optimize.least_squares."""
import ctypes as c, sys

import numpy as np
from scipy.optimize import least_squares

lib = c.CDLL(sys.argv[1])
R, MAX = 8e-3, 32

class Vec(c.Structure):
    _fields_ = [("x", c.c_double), ("y", c.c_double), ("z", c.c_double)]

class Cap(c.Structure):
    _fields_ = [("rays", Vec * 2 * MAX), ("count", c.c_uint32), ("seeks_radius", c.c_bool), ("finger_radius", c.c_double),
                ("reach", c.c_double), ("gate", c.c_double), ("rim", Vec), ("out", Vec), ("rim_margin", c.c_double)]

class Finger(c.Structure):
    _fields_ = [("centre", Vec), ("radius", c.c_double), ("residual", c.c_double), ("used", c.c_uint32), ("gone", c.c_bool)]

def numbers(v):
    return np.array([v.x, v.y, v.z])

def distances(start, along, centre, radius):
    """Along each ray to the sphere; NaN: it misses."""
    w = start - centre
    b = (w * along).sum(1)
    with np.errstate(invalid="ignore"):
        return -b - np.sqrt(b * b - (w * w).sum(1) + radius * radius)

def slopes(start, along, centre, radius):
    """The distances' derivatives by centre and radius."""
    normal = (start + distances(start, along, centre, radius)[:, None] * along - centre) / radius
    return np.column_stack([normal, np.ones(len(normal))]) / (normal * along).sum(1)[:, None]

rng = np.random.default_rng(1)
worst = worst_residual = worst_bound = 0
fits = outliers = 0
for trial in range(600):
    n = int(rng.integers(16, MAX + 1))
    up = rng.normal(size=(n, 3))
    up[:, 2] = abs(up[:, 2])
    up /= np.linalg.norm(up, axis=1)[:, None]
    along = -up + 0.1 * rng.normal(size=(n, 3))
    along /= np.linalg.norm(along, axis=1)[:, None]
    start = 14e-3 * up * (1 + 0.05 * rng.normal(size=(n, 1)))
    cap = Cap(count=n, seeks_radius=bool(trial % 2), finger_radius=R, reach=14e-3, gate=1.2e-3, rim=Vec(0, 0, -2e-3),
              out=Vec(0, 0, -1), rim_margin=1e-3)
    for k in range(n):
        cap.rays[k][0], cap.rays[k][1] = Vec(*start[k]), Vec(*along[k])
    if lib.ethd_cap_check(c.byref(cap), None) != 0:
        sys.exit(f"trial {trial}: the cap is refused")
    centre = rng.uniform(-1.5e-3, 1.5e-3, 3)
    true = np.append(centre, R + (rng.uniform(-1e-3, 1e-3) if cap.seeks_radius else 0))
    r = distances(start, along, true[:3], true[3]) + 0.15e-3 * rng.normal(size=n)
    stray = rng.choice(n, 2, replace=False)
    r[stray] += rng.choice([-4e-3, 4e-3], 2)
    finger = Finger()
    if lib.ethd_cap_step(c.byref(cap), (c.c_double * n)(*r), c.byref(finger)) != 0:
        sys.exit(f"trial {trial}: no finger")
    used = np.array([finger.used >> k & 1 for k in range(n)], bool)
    outliers += used[stray].sum()

    def unknown(x):
        return (x[:3], x[3]) if cap.seeks_radius else (x, R)

    def residuals(x):
        return (r[used] - distances(start[used], along[used], *unknown(x))) * 1e3
    unknowns = 4 if cap.seeks_radius else 3

    def jacobian(x):
        return -1e3 * slopes(start[used], along[used], *unknown(x))[:, :unknowns]
    best = least_squares(residuals, true[:unknowns], jacobian, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15)
    got = np.append(numbers(finger.centre), finger.radius)[:unknowns]
    worst = max(worst, abs(got - best.x).max())
    worst_residual = max(worst_residual, abs(finger.residual - np.sqrt((residuals(best.x) ** 2).mean()) * 1e-3))
    expected = distances(start, along, *unknown(best.x))
    within = np.abs(r - expected) <= cap.gate
    if (used & ~within).any():
        sys.exit(f"trial {trial}: a ray beyond the gate was used")
    fits += 1

    # The bound, at the true centre of a finger of the nominal radius.
    g = slopes(start, along, centre, R)
    g = g[np.abs(g[:, 3]) < 3] # 1 / slope: those that don't graze it
    sd = np.sqrt(np.diag(np.linalg.inv(g[:, :unknowns].T @ g[:, :unknowns])))[:3] * 1e-4
    bound = Vec()
    lib.ethd_cap_bound.argtypes = [c.POINTER(Cap), Vec, c.c_double, c.POINTER(Vec)]
    if lib.ethd_cap_bound(c.byref(cap), Vec(*centre), 1e-4, c.byref(bound)) != 0:
        sys.exit(f"trial {trial}: no bound")
    worst_bound = max(worst_bound, abs(numbers(bound) / sd - 1).max())

print(f"{fits} fits of caps of 16 to 32 rays with noise and two strays against SciPy: centre and radius within {worst:.1e} m, "
      f"residual {worst_residual:.1e} m, bound {worst_bound:.1e}; {outliers} strays used")
if worst > 1e-9 or worst_residual > 1e-9 or worst_bound > 1e-9 or outliers:
    sys.exit("FAILED: over 1e-9, or a stray was used")
