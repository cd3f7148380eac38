"""The scene that is made of a drawing, as text and as a picture."""
import base64
import math
import subprocess
from typing import Any, Dict, List, NamedTuple, Sequence, Tuple

import numpy as np

from ethd_programs.cli import plural
from ethd_programs.drawing.geometry import Points, covered

DIGITS = 7  #: decimals of a coordinate in m


class Thing(NamedTuple):
    """An object of a scene: its word, and its numbers."""

    shape: str
    numbers: Tuple[float, ...]


class Scene:
    """Objects, each once, and what there is to say about the drawing: lines for people."""

    def __init__(self) -> None:
        self.things: Dict[Thing, None] = {}
        self.notes: List[str] = []
        self.blank = self.twice = self.holes = 0

    def _add(self, shape: str, *numbers: float) -> None:
        thing = Thing(shape, tuple(round(float(n), DIGITS) + 0.0 for n in numbers))
        self.twice += thing in self.things
        self.things[thing] = None

    def note_shapes(self, *notes: Tuple[int, str]) -> None:
        self.notes += [f"{count} shape{plural(count)} {what}" for count, what in notes if count]

    def circle(self, centre: Points, radius: float) -> None:
        self._add("circle", *centre, radius)

    def wall(self, points: Points, closed: bool) -> None:
        points = _rounded(points)
        if len(points) < 2:
            self.blank += 1
        elif len(points) == 2:
            self._add("segment", *points.ravel())
        else:
            self._add("polyline", *(np.vstack([points, points[:1]]) if closed else points).ravel())

    def solid(self, shape: Any, circles: Sequence[Tuple[Points, float, Points]] = ()) -> None:
        """What a filled path covers: polygons, and the outlines of those that have holes, since a scene's objects have none.
        A polygon that is one of `circles` (centre, radius, vertices) becomes that circle."""
        for polygon in getattr(shape, "geoms", [shape]):
            if polygon.geom_type != "Polygon" or polygon.is_empty:
                continue
            outline = _rounded(np.array(polygon.exterior.coords)[:-1])
            if len(outline) < 3:
                self.blank += 1
            elif polygon.interiors:
                self.holes += 1
                for ring in (polygon.exterior, *polygon.interiors):
                    self.wall(np.array(ring.coords)[:-1], True)
            elif not self._circle(polygon, circles) and not self._box(outline):
                self._polygon(outline)

    def _polygon(self, outline: Points) -> None:
        """Rounding can make edges meet that nearly did; what they enclose apart from that is kept."""
        from shapely.geometry import Polygon

        whole = Polygon(outline)
        if whole.is_valid:
            self._add("polygon", *outline.ravel())
            return
        for piece in getattr(covered([outline], False), "geoms", []):
            if piece.geom_type == "Polygon" and piece.area > 1e-6 * whole.envelope.area:
                self._add("polygon", *np.array(piece.exterior.coords)[:-1].ravel())

    def _circle(self, polygon: Any, circles: Sequence[Tuple[Points, float, Points]]) -> bool:
        corners = {tuple(p) for p in np.array(polygon.exterior.coords)}
        for centre, radius, vertices in circles:
            if corners == {tuple(p) for p in vertices}:
                self.circle(centre, radius)
                return True
        return False

    def _box(self, p: Points) -> bool:
        """Four corners at right angles are a box."""
        if len(p) != 4:
            return False
        a, b, c = p[1] - p[0], p[2] - p[1], p[3] - p[2]
        if abs(a @ b) > 3e-7 * max(np.hypot(*a), np.hypot(*b)) or np.hypot(*(a + c)) > 3e-7:
            return False
        if abs(a[1]) > abs(a[0]):
            a, b = b, a
        angle = math.atan2(a[1], a[0])
        angle -= math.pi * round(angle / math.pi)
        self._add("box", *p.mean(axis=0), np.hypot(*a) / 2, np.hypot(*b) / 2, angle)
        return True

    def text(self) -> str:
        return "".join(f"{t.shape} {' '.join(map(_number, t.numbers))}\n" for t in self.things)

    def counts(self) -> str:
        edges = sum(len(t.numbers) // 2 - (t.shape != "polygon") for t in self.things if t.shape in ("polygon", "polyline", "segment"))
        return f"{len(self.things)} object{plural(len(self.things))}, {edges} segment{plural(edges)}"


def _rounded(points: Points) -> Points:
    points = np.round(points, DIGITS)
    keep = (points != np.roll(points, 1, axis=0)).any(axis=1)
    kept: Points = points[keep] if keep.any() else points[:1]
    return kept


def _number(value: float) -> str:
    return str(int(value)) if value == int(value) else repr(value)


# ---- picture ----

_SIDE = 900  #: pixels of each half


def _outlines(scene: Scene) -> List[str]:
    drawn = []
    for t in scene.things:
        n = t.numbers
        if t.shape == "circle":
            drawn.append(f'<circle cx="{n[0]}" cy="{n[1]}" r="{n[2]}" class="solid"/>')
        elif t.shape == "box":
            place = f"translate({n[0]} {n[1]}) rotate({math.degrees(n[4])})"
            drawn.append(f'<rect x="{-n[2]}" y="{-n[3]}" width="{2 * n[2]}" height="{2 * n[3]}" transform="{place}" class="solid"/>')
        else:
            tag = "polygon" if t.shape == "polygon" else "polyline"
            drawn.append(f'<{tag} points="{" ".join(map(str, n))}" class="{"solid" if tag == "polygon" else "wall"}"/>')
    return drawn


def picture(scene: Scene, original: bytes, frame: Tuple[float, float, float, float]) -> bytes:
    """A PNG: the drawing as it is (a PNG of the frame, or nothing), and beside it the scene, solids grey and walls blue.
    `frame` is the drawing's lower left corner and its size, m."""
    x, y, width, height = frame
    scale = _SIDE / max(width, height)
    w, h = width * scale, height * scale
    image = base64.b64encode(original).decode()
    body = "\n".join(_outlines(scene))
    svg = f"""<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="{2 * w + 30}" height="{h + 20}">
<style>.solid {{fill:#999}} .wall {{fill:none;stroke:#0072b2;stroke-width:{2 / scale}}} .frame {{fill:none;stroke:#ccc}}</style>
<rect width="100%" height="100%" fill="#fff"/>
<image x="10" y="10" width="{w}" height="{h}" xlink:href="data:image/png;base64,{image}"/>
<rect x="10" y="10" width="{w}" height="{h}" class="frame"/><rect x="{w + 20}" y="10" width="{w}" height="{h}" class="frame"/>
<g transform="translate({w + 20 - x * scale} {10 + h + y * scale}) scale({scale} {-scale})">{body}</g></svg>"""
    return subprocess.run(["rsvg-convert"], input=svg.encode(), stdout=subprocess.PIPE, check=True).stdout
