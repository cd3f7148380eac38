"""Runs rsvg-convert, and reads the plain paths that it writes: lines and cubic curves, with fill, stroke and clip path."""
import re
import resource
import subprocess
import xml.etree.ElementTree as xml
from typing import Any, Iterator, List, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from ethd_programs.cli import FAILED, Refusal, quoted
from ethd_programs.drawing.geometry import Part, Points, covered, points_of
from ethd_programs.drawing.svg_source import IGNORED, LINK, SVG, Page, local, opacity_of, property_of

PIXELS = 3e6  #: of the larger side of what librsvg draws, three times the page: its coordinates are steps of 1/256 pixel


def wrapped(root: Any, page: Page) -> bytes:
    """The drawing amid a page three times as large, so that what leaves its page is seen."""
    w, h = page.width, page.height
    zoom = PIXELS / (3 * max(w, h))
    outer = xml.Element(SVG + "svg", {"width": f"{3 * w * zoom!r}", "height": f"{3 * h * zoom!r}", "viewBox": f"{-w!r} {-h!r} {3 * w!r} {3 * h!r}"})
    for name, value in (("x", "0"), ("y", "0"), ("width", repr(w)), ("height", repr(h)), ("overflow", "visible")):
        root.set(name, value)
    style = re.sub(r"(?:^|;)\s*(width|height|overflow|x|y)\s*:[^;]*", ";", root.get("style") or "")
    root.set("style", f"{style};overflow:visible".lstrip(";"))
    sheet = xml.SubElement(root, SVG + "style")
    sheet.text = "*{" + "".join(f"{name}:none !important;" for name in IGNORED) + "}"
    outer.append(root)
    return xml.tostring(outer)


def _limited() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    resource.setrlimit(resource.RLIMIT_CPU, (120, 120))


def rsvg(arguments: List[str], svg: bytes) -> "subprocess.CompletedProcess[bytes]":
    try:
        return subprocess.run(["rsvg-convert", *arguments], input=svg, capture_output=True, preexec_fn=_limited)
    except FileNotFoundError:
        raise Refusal("rsvg-convert is missing, which reads SVG (Debian: librsvg2-bin)", FAILED) from None


class Drawn(NamedTuple):
    """A path as librsvg draws it."""

    parts: List[Part]
    fill: Optional[str]
    even_odd: bool
    stroked: bool
    clip: Any  #: a shape of shapely's, None: none


def _matrix(text: Optional[str]) -> "NDArray[np.float64]":
    m: "NDArray[np.float64]" = np.eye(3)
    for name, numbers in re.findall(r"(\w+)\(([^)]*)\)", text or ""):
        v = [float(n) for n in re.split(r"[\s,]+", numbers.strip())]
        if name == "matrix":
            m = m @ np.array([[v[0], v[2], v[4]], [v[1], v[3], v[5]], [0, 0, 1]])
        elif name == "translate":
            m = m @ np.array([[1, 0, v[0]], [0, 1, v[1] if len(v) > 1 else 0], [0, 0, 1]])
        elif name == "scale":
            m = m @ np.diag([v[0], v[-1], 1])
        else:
            raise ValueError(name)
    return np.asarray(m)


def _parts(data: str, m: Any) -> List[Part]:
    tokens, at, parts = data.split(), 0, []
    start: Optional[Points] = None
    pieces: List[Points] = []

    def put(p: List[str]) -> Points:
        points = np.array(p, float).reshape(-1, 2)
        return np.asarray(points @ m[:2, :2].T + m[:2, 2])

    def end(closed: bool) -> None:
        nonlocal pieces
        if start is not None and pieces:
            parts.append(Part(start, pieces, closed))
        pieces = []

    while at < len(tokens):
        command = tokens[at]
        count = {"M": 2, "L": 2, "C": 6, "Z": 0}.get(command)
        if count is None:
            raise Refusal(f"rsvg-convert writes {quoted(command)} in a path, which isn't known here", FAILED)
        numbers = tokens[at + 1 : at + 1 + count]
        at += 1 + count
        if command == "Z":
            end(True)
        elif command == "M":
            end(False)
            start = put(numbers)[0]
        else:
            pieces.append(put(numbers))
    end(False)
    return parts


class Reader:
    """Walks what rsvg-convert wrote: groups, clip paths, symbols that are used, paths and rectangles."""

    def __init__(self, root: Any, to_metres: Any, tolerance: float):
        self.by_id = {e.get("id"): e for e in root.iter() if e.get("id")}
        self.to_metres, self.tolerance = to_metres, tolerance
        self.images = 0

    def walk(self, e: Any, m: Any, clip: Any) -> Iterator[Drawn]:
        name = local(e)
        if name not in ("svg", "g", "symbol", "use", "image", "path", "rect"):
            return
        m = m @ _matrix(e.get("transform"))
        clip = self._clipped(e, m, clip)
        if name in ("svg", "g", "symbol"):
            for child in e:
                yield from self.walk(child, m, clip)
        elif name == "use":
            of = self.by_id.get((e.get(LINK) or e.get("href") or "#")[1:])
            if of is not None:
                m = m @ _matrix(f"translate({e.get('x') or 0},{e.get('y') or 0})")
                yield from self.walk(of, m, clip)
        elif name == "image":
            self.images += 1
        else:
            yield self._path(e, m, clip)

    def _clipped(self, e: Any, m: Any, clip: Any) -> Any:
        found = re.search(r"url\(#?\"?#?([^)\"]+)\"?\)", property_of(e, "clip-path") or "")
        if not found or found.group(1) not in self.by_id:
            return clip
        inner: Any = None
        for path in self.by_id[found.group(1)]:
            rule = property_of(path, "clip-rule") or property_of(e, "clip-rule")
            rings = [points_of(part._replace(closed=True), self.tolerance) for part in _parts(_data(path), self.to_metres @ m @ _matrix(path.get("transform")))]
            shape = covered(rings, rule == "evenodd")
            inner = shape if inner is None else inner.union(shape)
        return inner if clip is None else clip.intersection(inner) if inner is not None else clip

    def _path(self, e: Any, m: Any, clip: Any) -> Drawn:
        def seen(name: str, otherwise: str) -> Optional[str]:
            paint = property_of(e, name) or otherwise
            if paint == "none" or opacity_of(property_of(e, name + "-opacity") or "1") <= 0:
                return None
            found = re.match(r"rgba\(.*,\s*0(\.0*)?\)", paint)
            return None if found else paint

        fill = seen("fill", "#000")
        return Drawn(_parts(_data(e), self.to_metres @ m), fill, property_of(e, "fill-rule") == "evenodd", seen("stroke", "none") is not None, clip)


def _data(e: Any) -> str:
    if local(e) == "path":
        return e.get("d") or ""
    x, y, w, h = (float(e.get(name) or 0) for name in ("x", "y", "width", "height"))
    return f"M {x} {y} L {x + w} {y} L {x + w} {y + h} L {x} {y + h} Z"
