"""Runs the example `mesh` on balls of triangles, and works out by NumPy from all triangles where it ought to stand."""
import itertools
import subprocess
import sys

import numpy as np

RADIUS, STAND_OFF = 0.2, 0.068


def ball(level: int) -> np.ndarray:
    """An icosahedron whose edges are halved `level` times, turned so that no corner is on an axis: n x 3 corners x 3."""
    g = (1 + 5**0.5) / 2
    points = np.array([p for a, b in itertools.product((-1, 1), (-g, g)) for p in ((0, a, b), (a, b, 0), (b, 0, a))])
    near = np.abs(np.linalg.norm(points[:, None] - points, axis=2) - 2) < 1e-9
    faces = [f for f in itertools.combinations(range(12), 3) if all(near[i, j] for i, j in itertools.combinations(f, 2))]
    t = points[np.array(faces)]
    for _ in range(level):
        a, b, c = t[:, 0], t[:, 1], t[:, 2]
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        t = np.concatenate([np.stack(s, 1) for s in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    t *= RADIUS / np.linalg.norm(t, axis=2, keepdims=True)
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    t = t @ turn
    outward = np.einsum("ij,ij->i", np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), t[:, 0]) > 0
    t[~outward] = t[~outward][:, [0, 2, 1]]
    return t


def distance(t: np.ndarray, x: np.ndarray) -> float:
    """The distance from x, outside, to the nearest of all triangles: by edges, and by planes where the foot is inside."""
    best = np.inf
    for i in range(3):
        a, b = t[:, i], t[:, (i + 1) % 3]
        share = np.clip(np.einsum("ij,ij->i", x - a, b - a) / np.einsum("ij,ij->i", b - a, b - a), 0, 1)
        best = min(best, np.linalg.norm(a + share[:, None] * (b - a) - x, axis=1).min())
    n = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    h = np.einsum("ij,ij->i", x - t[:, 0], n)
    foot = x - h[:, None] * n
    inside = np.ones(len(t), bool)
    for i in range(3):
        a, b = t[:, i], t[:, (i + 1) % 3]
        inside &= np.einsum("ij,ij->i", np.cross(b - a, foot - a), n) >= 0
    return min(best, np.abs(h[inside]).min(initial=np.inf))


mesh, folder = sys.argv[1:]
for level in (2, 4, 6):
    t = ball(level)
    corners, index = np.unique(t.reshape(-1, 3), axis=0, return_inverse=True)
    with open(f"{folder}/ball.obj", "w") as out:
        out.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in corners)
        out.writelines(f"f {a} {b} {c}\n" for a, b, c in index.reshape(-1, 3) + 1)
    said = subprocess.run([mesh, f"{folder}/ball.obj"], capture_output=True, text=True, check=True).stdout.splitlines()
    x = np.array([float(word) for word in said[-1].split()[:3]])
    off = distance(t, x) - STAND_OFF
    round_ball = float(np.linalg.norm(x)) - RADIUS - STAND_OFF
    sagitta = RADIUS * 1.5 * 4 / len(t)  # of a face of area 4 pi R^2 / N, roughly
    print(f"{len(t):6d} triangles: {1e6 * off:7.3f} um off the mesh, {1e6 * round_ball:8.3f} um off the ball")
    assert len(said) == 60 and abs(off) < 2e-6, off
    assert -sagitta < round_ball < 2e-6, (round_ball, sagitta)

# A plate of 5 mm, of faces with four corners: its back is nearer than the stand-off, and isn't met from the front.
with open(f"{folder}/plate.obj", "w") as out:
    out.writelines(f"v {x} {y} {z}\n" for x in (0, 0.005) for y in (-0.4, 0.6) for z in (-0.3, 0.5))
    out.writelines(f"f {face}\n" for face in ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"))
said = subprocess.run([mesh, f"{folder}/plate.obj"], capture_output=True, text=True, check=True).stdout.splitlines()
x, left = float(said[-1].split()[0]), float(said[-1].split()[4])
print(f"{1e6 * (x + STAND_OFF):7.3f} um off a plate")
assert abs(x + STAND_OFF) < 2e-6 and abs(left) < 2e-6, (x, left)
# Without triangles, and inside out.
inverted = open(f"{folder}/plate.obj").read().splitlines()
inverted = [" ".join(["f", *line.split()[:0:-1]]) if line[0] == "f" else line for line in inverted]
for text in ("v 0 0 0\nv 1 0 0\nl 1 2\n", "\n".join(inverted)):
    with open(f"{folder}/bad.obj", "w") as out:
        out.write(text)
    refused = subprocess.run([mesh, f"{folder}/bad.obj"], capture_output=True, text=True, check=False)
    assert refused.returncode == 1 and "bad.obj: no closed mesh, or its triangles are clockwise" in refused.stderr, refused
