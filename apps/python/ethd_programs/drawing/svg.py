"""Reads SVG. librsvg resolves style sheets, units, use, clip paths, transforms and visibility: rsvg-convert writes the drawing
as plain paths, of lines and cubic curves. What it gets wrong silently is refused, and what no scene can hold is left out."""
import collections
import re
import resource
import subprocess
import xml.etree.ElementTree as xml
from typing import Any, Counter, Dict, Iterator, List, NamedTuple, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd_programs.cli import FAILED, Refusal, plural, quoted
from ethd_programs.drawing.geometry import Part, Points, circle_of, covered, points_of
from ethd_programs.drawing.scene import Scene

_SVG, _LINK = "{http://www.w3.org/2000/svg}", "{http://www.w3.org/1999/xlink}href"
_INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}version"
_PIXELS = 3e6  #: of the larger side of what librsvg draws, three times the page: its coordinates are steps of 1/256 pixel
_UNITS = {"": 1.0, "px": 1.0, "in": 96.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "pt": 96 / 72, "pc": 16.0, "q": 96 / 101.6}
_METRES = 0.0254 / 96  #: of a pixel
#: Elements that no scene can hold.
_LEFT_OUT = ("text", "image", "foreignObject", "flowRoot", "script", "video", "audio", "iframe", "canvas", "animate", "animateTransform", "animateMotion", "set")  # fmt: skip
#: Properties that change what is seen but not where a shape is.
_IGNORED = ("filter", "mask", "marker-start", "marker-mid", "marker-end", "stroke-dasharray")


class Options(NamedTuple):
    tolerance: float = 1e-5  #: m
    scale: Optional[float] = None  #: m per user unit; None: what the drawing says
    origin: Tuple[float, float] = (0.0, 0.0)  #: m: of the page's lower left corner
    page: Optional[str] = None  #: SVG: what a filled shape that covers the page is: solid or background
    units: Optional[str] = None  #: DXF: a name of its unit; None: what the file says


class Page(NamedTuple):
    width: float  #: px
    height: float
    unit: float  #: px per user unit
    metres: float  #: per px


# ---- the source ----


def _local(element: Any) -> str:
    return element.tag[len(_SVG) :] if isinstance(element.tag, str) and element.tag.startswith(_SVG) else ""


def _styles(root: Any) -> str:
    """All that style sheets and style attributes say."""
    sheets = [e.text or "" for e in root.iter(_SVG + "style")]
    return "\n".join(re.sub(r"/\*.*?\*/", "", text, flags=re.S) for text in sheets + [e.get("style") or "" for e in root.iter()])


def _refuse_unknown(path: str, root: Any) -> None:
    """What librsvg doesn't know, and draws as if it weren't there."""
    text = _styles(root)
    for pattern, what in (
        (r"transform-(origin|box)", "transform-origin"),
        (r"@(import|media|font-face\s*\{[^}]*\}\s*[^\s])", "@import and @media"),
        (r"\b(var|calc|min|max|clamp|env)\(", "computed values such as var() and calc()"),
        (r"\b(offset-path|clip-path\s*:\s*(?!url|none|inherit)[a-z])", "clip-path by a basic shape"),
        (r"(?:^|[;{\s])(d|rotate|translate|scale)\s*:", "geometry in a style"),
    ):
        if re.search(pattern, text):
            raise Refusal(f"{path}: {what} in a style isn't supported; save the drawing as plain SVG")
    for e in root.iter():
        if e.get("transform-origin"):
            raise Refusal(f"{path}: transform-origin isn't supported; save the drawing as plain SVG, with transforms applied")
    _refuse_uses(path, root)
    _refuse_transparent(path, root)


def _refuse_uses(path: str, root: Any) -> None:
    by_id = {e.get("id"): e for e in root.iter() if e.get("id")}

    def target(e: Any) -> Any:
        return by_id.get((e.get(_LINK) or e.get("href") or "#")[1:])

    for e in root.iter(_SVG + "use"):
        link = e.get(_LINK) or e.get("href") or ""
        if not link.startswith("#"):
            raise Refusal(f"{path}: use of another file, {quoted(link)}, isn't supported")
        of = target(e)
        if of is not None and _local(of) in ("svg", "symbol") and (e.get("width") or e.get("height")):
            raise Refusal(f"{path}: use with a width or height of a symbol isn't supported; unlink the clone in the drawing's editor")
    inner = {k: [target(u) for u in e.iter(_SVG + "use")] for k, e in by_id.items()}
    state: Dict[str, int] = {}

    def visit(name: str) -> None:
        if state.get(name) == 1:
            raise Refusal(f"{path}: {quoted(name)} uses itself")
        if state.get(name) is None:
            state[name] = 1
            for of in inner[name]:
                if of is not None:
                    visit(of.get("id"))
            state[name] = 2

    for name in by_id:
        visit(name)


def _refuse_transparent(path: str, root: Any) -> None:
    for e in root.iter(_SVG + "stop"):
        found = re.search(r"stop-opacity\s*:\s*([^;]+)", e.get("style") or "")
        opacity = (found.group(1) if found else e.get("stop-opacity") or "1").strip()
        colour = f"{e.get('style') or ''} {e.get('stop-color') or ''}"
        if _share(opacity) < 1 or "transparent" in colour:
            raise Refusal(f"{path}: a gradient that is transparent somewhere has no edge there; fill the shape with a colour")


def _share(text: str) -> float:
    """An opacity, 1 where it is none."""
    found = re.fullmatch(r"(\d+\.?\d*|\.\d+)(%?)", text.strip())
    return float(found.group(1)) / (100 if found.group(2) else 1) if found else 1.0


def _leave_out(root: Any) -> Counter[str]:
    """Removes what no scene can hold, and counts it."""
    count: Counter[str] = collections.Counter()
    for parent in list(root.iter()):
        for child in list(parent):
            name = _local(child)
            if name in _LEFT_OUT:
                count["text" if name == "flowRoot" else name] += 1
                parent.remove(child)
            elif name == "pattern":  # a shape is solid whatever its pattern is
                child.tag = _SVG + "linearGradient"
                kept = child.get("id")
                child[:] = []
                child.attrib.clear()
                child.set("id", kept or "")
                xml.SubElement(child, _SVG + "stop", {"stop-color": "#000"})
                count["pattern"] += 1
    text = _styles(root)
    for name in _IGNORED:
        marks = len(re.findall(rf"(?:^|[;{{\s]){name}\s*:\s*(?!none|inherit|0\b)", text)) + sum(
            (e.get(name) or "none") not in ("none", "inherit", "0") for e in root.iter()
        )
        count[name.split("-")[0] if name.startswith("marker") else "dash" if name.startswith("stroke") else name] += marks
    return count


# ---- the page ----


def _length(text: Optional[str]) -> Optional[float]:
    """px; None: a share of what isn't known, or nothing."""
    found = re.fullmatch(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([a-zA-Z]*)\s*", text or "")
    factor = _UNITS.get(found.group(2).lower()) if found else None
    return float(found.group(1)) * factor if found and factor else None


def _own(root: Any, name: str) -> Optional[str]:
    found = re.search(rf"(?:^|;)\s*{name}\s*:\s*([^;]+)", root.get("style") or "")
    value: Optional[str] = found.group(1).strip() if found else root.get(name)
    return None if value in (None, "auto") else value


def _page(path: str, root: Any, options: Options) -> Page:
    size = [_own(root, "width"), _own(root, "height")]
    width, height = map(_length, size)
    for text, value in zip(size, (width, height)):
        if text and (value is None and not text.strip().endswith("%") or value is not None and value <= 0):
            raise Refusal(f"{path}: width and height are lengths over 0: found {quoted(text)}")
    box = [float(n) for n in re.findall(r"[-+.\deE]+", root.get("viewBox") or "")]
    if root.get("viewBox") is not None and (len(box) != 4 or box[2] <= 0 or box[3] <= 0 or max(box[2:]) > 1e7):
        raise Refusal(f"{path}: viewBox: found {quoted(root.get('viewBox'))}, four numbers are needed, the last two from 0 to 1e7")
    said = width is not None or height is not None
    if not box:
        if width is None or height is None:
            if options.scale is None:
                raise Refusal(f"{path}: no width or height says how large it is; --scale does, in m per user unit")
            raise Refusal(f"{path}: neither width and height nor a viewBox says how large its page is")
        box = [0, 0, width, height]
    if width is None and height is None:
        width, height = box[2], box[3]
    if width is None or height is None:
        width, height = width or box[2] / box[3] * (height or 0), height or box[3] / box[2] * (width or 0)
    across, up = width / box[2], height / box[3]
    if abs(across - up) > 1e-3 * up and (root.get("preserveAspectRatio") or "").strip() == "none":
        raise Refusal(f"{path}: width and height stretch the viewBox, which isn't supported")
    unit = min(across, up)
    if options.scale is None:
        _refuse_doubtful(path, root, said, size)
    metres = _METRES if options.scale is None else options.scale / unit
    return Page(width, height, unit, metres)


def _refuse_doubtful(path: str, root: Any, said: bool, size: List[Optional[str]]) -> None:
    if not said:
        raise Refusal(f"{path}: no width or height says how large it is; --scale does, in m per user unit")
    pixels = all(re.fullmatch(r"[\d.eE+-]*\s*(px)?|.*%", (text or "").strip()) for text in size)
    found = re.match(r"0\.(\d+)", root.get(_INKSCAPE) or "")
    if pixels and found and int(found.group(1)[:2].ljust(2, "0")) < 92:
        raise Refusal(f"{path}: drawn by Inkscape {root.get(_INKSCAPE)}, whose px were 1/90 inch: --scale 2.8222222e-4 says so, 2.6458333e-4 that they are 1/96")


# ---- what librsvg makes of it ----


def _wrapped(root: Any, page: Page) -> bytes:
    """The drawing amid a page three times as large, so that what leaves its page is seen."""
    w, h = page.width, page.height
    zoom = _PIXELS / (3 * max(w, h))
    outer = xml.Element(_SVG + "svg", {"width": f"{3 * w * zoom!r}", "height": f"{3 * h * zoom!r}", "viewBox": f"{-w!r} {-h!r} {3 * w!r} {3 * h!r}"})
    for name, value in (("x", "0"), ("y", "0"), ("width", repr(w)), ("height", repr(h)), ("overflow", "visible")):
        root.set(name, value)
    style = re.sub(r"(?:^|;)\s*(width|height|overflow|x|y)\s*:[^;]*", ";", root.get("style") or "")
    root.set("style", f"{style};overflow:visible".lstrip(";"))
    sheet = xml.SubElement(root, _SVG + "style")
    sheet.text = "*{" + "".join(f"{name}:none !important;" for name in _IGNORED) + "}"
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


class _Reader:
    """Walks what rsvg-convert wrote: groups, clip paths, symbols that are used, paths and rectangles."""

    def __init__(self, root: Any, to_metres: Any, tolerance: float):
        self.by_id = {e.get("id"): e for e in root.iter() if e.get("id")}
        self.to_metres, self.tolerance = to_metres, tolerance
        self.images = 0

    def walk(self, e: Any, m: Any, clip: Any) -> Iterator[Drawn]:
        name = _local(e)
        if name not in ("svg", "g", "symbol", "use", "image", "path", "rect"):
            return
        m = m @ _matrix(e.get("transform"))
        clip = self._clipped(e, m, clip)
        if name in ("svg", "g", "symbol"):
            for child in e:
                yield from self.walk(child, m, clip)
        elif name == "use":
            of = self.by_id.get((e.get(_LINK) or e.get("href") or "#")[1:])
            if of is not None:
                m = m @ _matrix(f"translate({e.get('x') or 0},{e.get('y') or 0})")
                yield from self.walk(of, m, clip)
        elif name == "image":
            self.images += 1
        else:
            yield self._path(e, m, clip)

    def _clipped(self, e: Any, m: Any, clip: Any) -> Any:
        found = re.search(r"url\(#?\"?#?([^)\"]+)\"?\)", _property(e, "clip-path") or "")
        if not found or found.group(1) not in self.by_id:
            return clip
        inner: Any = None
        for path in self.by_id[found.group(1)]:
            rule = _property(path, "clip-rule") or _property(e, "clip-rule")
            rings = [points_of(part._replace(closed=True), self.tolerance) for part in _parts(_data(path), self.to_metres @ m @ _matrix(path.get("transform")))]
            shape = covered(rings, rule == "evenodd")
            inner = shape if inner is None else inner.union(shape)
        return inner if clip is None else clip.intersection(inner) if inner is not None else clip

    def _path(self, e: Any, m: Any, clip: Any) -> Drawn:
        def seen(name: str, otherwise: str) -> Optional[str]:
            paint = _property(e, name) or otherwise
            if paint == "none" or _share(_property(e, name + "-opacity") or "1") <= 0:
                return None
            found = re.match(r"rgba\(.*,\s*0(\.0*)?\)", paint)
            return None if found else paint

        fill = seen("fill", "#000")
        return Drawn(_parts(_data(e), self.to_metres @ m), fill, _property(e, "fill-rule") == "evenodd", seen("stroke", "none") is not None, clip)


def _property(e: Any, name: str) -> Optional[str]:
    found = re.search(rf"(?:^|;)\s*{name}\s*:\s*([^;]+)", e.get("style") or "")
    value: Optional[str] = found.group(1).strip() if found else e.get(name)
    return value


def _data(e: Any) -> str:
    if _local(e) == "path":
        return e.get("d") or ""
    x, y, w, h = (float(e.get(name) or 0) for name in ("x", "y", "width", "height"))
    return f"M {x} {y} L {x + w} {y} L {x + w} {y + h} L {x} {y + h} Z"


# ---- a drawing as a scene ----


def _is_white(paint: str) -> bool:
    return re.sub(r"\s", "", paint).lower() in ("rgb(100%,100%,100%)", "rgb(255,255,255)", "#fff", "#ffffff", "white")


class Result(NamedTuple):
    scene: Scene
    frame: Tuple[float, float, float, float]
    original: bytes  #: a drawing of the page alone, for rsvg-convert


def read(path: str, data: bytes, options: Options) -> Result:
    from shapely.geometry import LineString, box

    try:
        root = xml.fromstring(data)
        original = xml.tostring(root)
    except (xml.ParseError, ValueError, LookupError, RecursionError) as e:
        raise Refusal(f"{path}: no XML: {e}") from None
    if _local(root) != "svg":
        raise Refusal(f"{path}: a drawing must begin with svg, of {_SVG[1:-1]}: found {quoted(str(root.tag))}")
    _refuse_unknown(path, root)
    page = _page(path, root, options)
    left_out = _leave_out(root)
    zoom = _PIXELS / (3 * max(page.width, page.height))
    done = rsvg(["-f", "svg"], _wrapped(root, page))
    if done.returncode:
        reason = done.stderr.decode(errors="replace").strip().split("\n")[-1]
        raise Refusal(f"{path}: librsvg can't draw it: {reason or f'rsvg-convert ended by {done.returncode}'}")
    k, (ox, oy) = page.metres, options.origin
    to_metres = np.array([[k / zoom, 0, ox - page.width * k], [0, -k / zoom, oy + 2 * page.height * k], [0, 0, 1]])
    width, height = page.width * k, page.height * k
    paper = box(ox, oy, ox + width, oy + height)
    scene, outside, across, white, pages = Scene(), 0, 0, 0, 0
    drawn = xml.fromstring(done.stdout)
    reader = _Reader(drawn, to_metres, options.tolerance)
    for shape in reader.walk(drawn, np.eye(3), None):
        if shape.fill is None and not shape.stroked:
            continue
        chains = [points_of(part, options.tolerance) for part in shape.parts]
        everything = np.vstack(chains) if chains else np.empty((0, 2))
        if not len(everything):
            scene.blank += 1
            continue
        low, high = everything.min(axis=0), everything.max(axis=0)
        if high[0] < ox - 1e-7 or low[0] > ox + width + 1e-7 or high[1] < oy - 1e-7 or low[1] > oy + height + 1e-7:
            outside += 1
            continue
        across += bool((low < np.array([ox, oy]) - 1e-3 * k * page.unit - 1e-6).any() or (high > np.array([ox + width, oy + height]) + 1e-6).any())
        if shape.fill is not None:
            body = covered(chains, shape.even_odd)
            if shape.clip is not None:
                body = body.intersection(shape.clip)
            if not body.is_empty and body.area > 0 and body.buffer(1e-3 * max(width, height)).contains(paper):
                pages += 1
                if options.page == "background":
                    continue
                if options.page is None:
                    raise Refusal(f"{path}: a filled shape covers the whole page: --page background leaves it out, --page solid makes an object of it")
            white += _is_white(shape.fill)
            if body.area > 0:
                round_ones = [(circle_of(part), points) for part, points in zip(shape.parts, chains)]
                scene.solid(body, [(*found, points) for found, points in round_ones if found])
                continue
        if shape.stroked:
            for part, points in zip(shape.parts, chains):
                closed = part.closed or (len(points) > 2 and np.abs(points[0] - points[-1]).max() <= 1e-8)
                if closed and not part.closed:
                    points = points[:-1]
                if shape.clip is None:
                    scene.wall(points, closed)
                elif len(points) > 1:
                    line = LineString(np.vstack([points, points[:1]]) if closed else points).intersection(shape.clip)
                    for piece in getattr(line, "geoms", [line]):
                        if piece.geom_type == "LineString" and not piece.is_empty:
                            scene.wall(np.array(piece.coords), False)
        else:
            scene.blank += 1
    left_out["image"] += reader.images
    if not scene.things:
        raise Refusal(f"{path}: nothing that a scene can hold is drawn on its page{f'; {outside} shapes lie outside' if outside else ''}")
    _note(scene, options, page, left_out, outside, across, white, pages)
    return Result(scene, (ox, oy, width, height), original)


def _note(scene: Scene, options: Options, page: Page, left_out: Counter[str], outside: int, across: int, white: int, pages: int) -> None:
    say, k = scene.notes.append, page.metres
    say(
        f"1 user unit = {page.unit * k:.9g} m; y up, the page's lower left corner at {options.origin[0]:.9g}, {options.origin[1]:.9g} m,"
        f" its size {page.width * k:.9g} x {page.height * k:.9g} m; curves within {options.tolerance:.3g} m"
    )
    gone = [f"{n} {name}" for name, n in left_out.items() if n and name not in ("filter", "mask", "marker", "dash", "pattern")]
    if gone:
        say(f"left out: {', '.join(gone)}")
    plain = [f"{left_out[name]} {name}{plural(left_out[name])}" for name in ("filter", "mask", "marker", "dash", "pattern") if left_out[name]]
    if plain:
        say(f"drawn without: {', '.join(plain)}")
    for count, what in (
        (scene.holes, "filled with holes: their outlines are walls"),
        (white, "filled with white: taken as solid"),
        (scene.twice, "drawn twice: kept once"),
        (outside, "outside of the page: left out"),
        (across, "beyond the page's edge: kept whole"),
        (pages if options.page == "background" else 0, "as large as the page: left out"),
        (scene.blank, "without length: left out"),
    ):
        if count:
            say(f"{count} shape{plural(count)} {what}")
