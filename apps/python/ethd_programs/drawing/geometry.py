"""Paths as solids and walls: arcs, edges of curves, and what a filled path covers."""
import math
from typing import Any, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]  #: (n, 2), m
QUARTER = math.pi / 2
SAME = 1e-9  #: m: nearer points are one


class Part(NamedTuple):
    """A part of a path, m: where it begins, and its pieces, each the points after the last one's end: one for a line, three for a
    cubic curve."""

    start: Points
    pieces: List[Points]
    closed: bool


class Arc(NamedTuple):
    """centre + u cos a + v sin a, for a from 0 to `turn`."""

    centre: Points
    u: Points
    v: Points
    turn: float


def arc_of(p: Points) -> Optional[Arc]:
    """The quarter of an ellipse, or the arc of a circle, that is written as the cubic curve of these four points: up to
    0.03 % of the radius lies between them."""
    out, back, chord = p[1] - p[0], p[3] - p[2], p[3] - p[0]
    near = 1e-5 * float(np.hypot(*chord))
    kappa = 4 / 3 * math.tan(QUARTER / 4)
    v, u = out / kappa, -back / kappa
    if float(np.hypot(*(p[0] - u - p[3] + v))) <= near:
        return Arc((p[0] - u + p[3] - v) / 2, u, v, QUARTER)
    lengths = float(np.hypot(*out)), float(np.hypot(*back))
    turn = math.atan2(out[0] * back[1] - out[1] * back[0], float(out @ back))
    if not 0.1 < abs(turn) <= QUARTER * 1.0001 or abs(lengths[0] - lengths[1]) > near:
        return None
    radius = float(np.hypot(*chord)) / (2 * math.sin(abs(turn) / 2))
    if abs(lengths[0] - 4 / 3 * math.tan(abs(turn) / 4) * radius) > near:
        return None
    v = out / lengths[0] * radius
    u = np.array([v[1], -v[0]]) * math.copysign(1, turn)
    return Arc(p[0] - u, u, v, abs(turn))


def _edges(bound: float) -> int:
    return max(1, math.ceil(bound)) if bound < 2e7 else 20_000_000


def _curve(p: Points, tolerance: float) -> Points:
    """The points after the first of edges that are at most `tolerance` away from the curve (Wang 1984)."""
    arc = arc_of(p)
    if arc:
        axis = math.sqrt(float(arc.u @ arc.u + arc.v @ arc.v))
        n = _edges(arc.turn / min(math.sqrt(8 * tolerance / axis), QUARTER / 2))
        a = np.arange(1, n)[:, None] * (arc.turn / n)
        inner: Points = arc.centre + np.cos(a) * arc.u + np.sin(a) * arc.v
    else:
        second = np.hypot(*(p[:-2] - 2 * p[1:-1] + p[2:]).T).max()
        n = _edges(math.sqrt(6 * second / (8 * tolerance)))
        t = np.arange(1, n)[:, None] / n
        inner = (1 - t) ** 3 * p[0] + 3 * (1 - t) ** 2 * t * p[1] + 3 * (1 - t) * t**2 * p[2] + t**3 * p[3]
    return np.asarray(np.vstack([inner, p[3:]]))


def apart(points: Points) -> Points:
    """Points without those that repeat the one before."""
    return np.asarray(points[np.append(True, np.abs(np.diff(points, axis=0)).max(axis=1, initial=0) > SAME)])


def points_of(part: Part, tolerance: float) -> Points:
    """Its vertices without consecutive duplicates; a closed part doesn't repeat the first."""
    found, at = [part.start[None]], part.start
    for piece in part.pieces:
        found.append(piece if len(piece) == 1 else _curve(np.vstack([at[None], piece]), tolerance))
        at = piece[-1]
    points = apart(np.vstack(found))
    while part.closed and len(points) > 1 and np.abs(points[0] - points[-1]).max() <= SAME:
        points = points[:-1]
    return np.asarray(points)


def circle_of(part: Part) -> Optional[Tuple[Points, float]]:
    """Centre and radius, if the part is four quarters of a circle."""
    curves = [piece for piece in part.pieces if len(piece) == 3]
    lines = [piece for piece in part.pieces if len(piece) == 1]
    if len(curves) != 4 or any(np.abs(line[0] - part.start).max() > 1e-7 for line in lines):
        return None
    at, arcs = part.start, []
    for curve in curves:
        arc = arc_of(np.vstack([at[None], curve]))
        if arc is None or arc.turn != QUARTER:
            return None
        arcs.append(arc)
        at = curve[-1]
    centre = np.mean([arc.centre for arc in arcs], axis=0)
    radii = np.array([np.hypot(*axis) for arc in arcs for axis in (arc.u, arc.v)])
    radius = float(radii.mean())
    round_enough = np.ptp(radii) <= 1e-5 * radius and all(abs(float(arc.u @ arc.v)) <= 1e-5 * radius**2 for arc in arcs)
    together = all(np.abs(arc.centre - centre).max() <= 1e-5 * radius for arc in arcs)
    return (centre, radius) if round_enough and together else None


# ---- what is filled ----


def _winding(at: Points, rings: Sequence[Points]) -> int:
    count = 0
    for ring in rings:
        a, b = ring, np.roll(ring, -1, axis=0)
        left = (b[:, 0] - a[:, 0]) * (at[1] - a[:, 1]) - (at[0] - a[:, 0]) * (b[:, 1] - a[:, 1])
        up = (a[:, 1] <= at[1]) & (b[:, 1] > at[1]) & (left > 0)
        down = (a[:, 1] > at[1]) & (b[:, 1] <= at[1]) & (left < 0)
        count += int(up.sum()) - int(down.sum())
    return count


def covered(rings: Sequence[Points], even_odd: bool) -> Any:
    """What a filled path covers, as a shape of shapely's: its parts are closed, and the rule says what is inside."""
    from shapely.geometry import LinearRing, Polygon
    from shapely.ops import polygonize, unary_union

    rings = [ring[:-1] if len(ring) and np.abs(ring[0] - ring[-1]).max() <= SAME else ring for ring in rings]
    rings = [ring for ring in rings if len(ring) >= 3]
    if not rings:
        return Polygon()
    if len(rings) == 1 and (whole := Polygon(rings[0])).is_valid:
        return whole
    faces = list(polygonize(unary_union([LinearRing(ring) for ring in rings])))

    def is_inside(face: Any) -> bool:
        at = face.representative_point()
        count = _winding(np.array([at.x, at.y]), rings)
        return count % 2 != 0 if even_odd else count != 0

    return unary_union([face for face in faces if is_inside(face)])
