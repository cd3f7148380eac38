"""Surfaces of solids against SciPy: solids.py LIBRARY.

Nothing here knows the library's formulae. A box is the convex hull of its corners, its nearest point a bounded least
squares; a capsule's distance is a minimum that is searched along its axis; rotations are SciPy's.
"""
import ctypes
import sys

import numpy as np
from scipy.optimize import lsq_linear, minimize_scalar
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

Vec = ctypes.c_double * 3


class Surface(ctypes.Structure):
    _fields_ = [("point", Vec), ("n", Vec), ("v", Vec), ("id", ctypes.c_int32), ("material", ctypes.c_int32)]


class Vec3(ctypes.Structure):
    _fields_ = [("x", ctypes.c_double), ("y", ctypes.c_double), ("z", ctypes.c_double)]


class Pose(ctypes.Structure):
    _fields_ = [("x", Vec), ("orientation", ctypes.c_double * 4), ("v", Vec), ("rate", Vec)]


library = ctypes.CDLL(sys.argv[1])
library.ethd_solids_surfaces.restype = ctypes.c_size_t
library.ethd_solids_surfaces.argtypes = [ctypes.c_void_p, ctypes.POINTER(Pose), Vec3, ctypes.c_double,
                                         ctypes.POINTER(Surface), ctypes.c_size_t]
random = np.random.default_rng(20)
MOST = 64


def parse(text):
    solids, error = ctypes.c_void_p(), ctypes.create_string_buffer(256)
    status = library.ethd_solids_parse(text.encode(), ctypes.c_size_t(len(text)), ctypes.byref(solids), error)
    assert status == 0, (status, text)
    return solids


def surfaces(solids, x, reach, pose=None):
    """(point, n, v, id) of each."""
    out = (Surface * MOST)()
    count = library.ethd_solids_surfaces(solids, pose and ctypes.byref(pose), Vec3(*x), reach, out, MOST)
    return [(np.array(s.point), np.array(s.n), np.array(s.v), s.id) for s in out[:count]]


# ---- solids, and their signed distance ----

class Halfspace:
    def __init__(self, scale):
        n = random.normal(size=3)
        self.n, self.c = n / np.linalg.norm(n), random.uniform(-scale, scale)
        self.numbers = ["halfspace", *self.n, self.c]

    def distance(self, x):
        return self.c - self.n @ x


class Sphere:
    def __init__(self, scale):
        self.centre, self.radius = random.uniform(-scale, scale, 3), random.uniform(0.01, 0.4)
        self.numbers = ["sphere", *self.centre, self.radius]

    def distance(self, x):
        return np.linalg.norm(x - self.centre) - self.radius


class Capsule:
    def __init__(self, scale):
        self.a, self.radius = random.uniform(-scale, scale, 3), random.uniform(0.01, 0.2)
        self.b = self.a + random.uniform(-0.6, 0.6, 3)
        self.numbers = ["capsule", *self.a, *self.b, self.radius]

    def distance(self, x):
        def at(t):
            return np.linalg.norm(self.a + t * (self.b - self.a) - x)
        inner = minimize_scalar(at, bounds=(0, 1), method="bounded", options={"xatol": 1e-13})
        return min(at(0), at(1), inner.fun) - self.radius


class Box:
    def __init__(self, scale):
        self.centre, self.half = random.uniform(-scale, scale, 3), random.uniform(0.02, 0.4, 3)
        turn = random.normal(size=3) * random.choice([0, 1e-9, 1, 5])
        self.axes = Rotation.from_rotvec(turn).as_matrix()
        self.numbers = ["box", *self.centre, *self.half, *(turn if turn.any() else [])]
        corners = self.half * np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, 8).T @ self.axes.T
        self.faces = ConvexHull(corners).equations

    def distance(self, x):
        r = x - self.centre
        outside = (self.faces[:, :3] @ r + self.faces[:, 3]).max()
        if outside <= 0:
            return outside
        nearest = lsq_linear(self.axes, r, (-self.half, self.half), method="bvls", tol=1e-15).x
        return np.linalg.norm(self.axes @ nearest - r)


def line(solid):
    return " ".join([solid.numbers[0], *(repr(float(v)) for v in solid.numbers[1:])]) + "\n"


# ---- standing still ----

def check(world, found, x, reach, tolerance):
    """The found surfaces are those of the world within reach, nearest first."""
    expected = {i: d for i, d in enumerate(s.distance(x) for s in world) if d <= reach}
    assert {f[3] for f in found} == set(expected) and len(found) == len(expected), (expected, found)
    depths = []
    for point, n, _, number in found:
        d = expected[number]
        depths.append(n @ (point - x))
        assert abs(np.linalg.norm(n) - 1) < 4e-15, n
        assert abs(depths[-1] - d) < tolerance, (world[number].numbers, x, d, depths[-1] - d)
        assert np.abs(x + d * n - point).max() < tolerance, (world[number].numbers, x)
        assert abs(world[number].distance(point)) < tolerance, (world[number].numbers, x, point)
    assert depths == sorted(depths)


KINDS = [Halfspace, Sphere, Capsule, Box]
counts = np.zeros(2, int)
for scale in 0.7, 1e4:
    for _ in range(60):
        world = [random.choice(KINDS)(scale) for _ in range(12)]
        solids = parse("".join(map(line, world)))
        for k in range(10):
            near = world[random.integers(len(world))]
            about = getattr(near, "centre", getattr(near, "a", np.zeros(3)))
            x, reach = about + random.normal(size=3) * random.choice([0.03, 0.3, 1]), random.uniform(-0.05, 0.5)
            found = surfaces(solids, x, reach if k else np.inf)
            check(world, found, x, reach if k else np.inf, 1e-12 * 3 * scale)
            counts += len(found), sum(n @ (p - x) < 0 for p, n, _, _ in found)
        library.ethd_solids_destroy(solids)
assert counts.min() > 100, counts
print(f"standing still: {counts[0]} surfaces, {counts[1]} of them from inside")

# ---- moving: the body's points at t = 0, and their differences over 2 h ----

moved, h = 0, 2e-6
for _ in range(200):
    world = [random.choice(KINDS)(0.7) for _ in range(6)]
    solids = parse("".join(map(line, world)))
    origin, v, rate, turn = random.uniform(-1, 1, 3), random.normal(size=3), random.normal(size=3) * 3, Rotation.random(
        random_state=random.integers(1 << 30))
    x, y, z, w = turn.as_quat()
    length = 1 + random.uniform(-9e-7, 9e-7)
    pose = Pose(Vec(*origin), (ctypes.c_double * 4)(*(length * q for q in (w, x, y, z))), Vec(*v), Vec(*rate))
    assert library.ethd_body_pose3_is_valid(ctypes.byref(pose)) & 1
    at = random.uniform(-1.5, 1.5, 3)
    inner = turn.inv().apply(at - origin)
    found, still = surfaces(solids, at, 0.8, pose), surfaces(solids, inner, 0.8)
    check(world, still, inner, 0.8, 3e-12)
    assert [f[3] for f in found] == [f[3] for f in still]
    for (point, n, speed, _), (p, m, stands, _) in zip(found, still):
        assert not stands.any()
        assert np.abs(origin + turn.apply(p) - point).max() < 1e-12 and np.abs(turn.apply(m) - n).max() < 1e-11
        after, before = (origin + t * v + (Rotation.from_rotvec(t * rate) * turn).apply(p) for t in (h, -h))
        assert np.abs((after - before) / (2 * h) - speed).max() < 1e-8, (speed, (after - before) / (2 * h))
        moved += 1
    library.ethd_solids_destroy(solids)
assert moved > 300, moved
print(f"moving: {moved} surfaces")
