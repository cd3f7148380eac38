"""Reads the source of an SVG drawing: what librsvg gets wrong silently is refused, what no scene can hold is removed and
counted, and the size of the page is found."""
import collections
import graphlib
import re
import xml.etree.ElementTree as xml
from typing import Any, Counter, List, NamedTuple, Optional, Tuple

from ethd_programs.cli import Refusal, quoted

SVG, LINK = "{http://www.w3.org/2000/svg}", "{http://www.w3.org/1999/xlink}href"
_INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}version"
_UNITS = {"": 1.0, "px": 1.0, "in": 96.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "pt": 96 / 72, "pc": 16.0, "q": 96 / 101.6}
_METRES = 0.0254 / 96  #: of a pixel
#: Elements that no scene can hold.
_LEFT_OUT = ("text", "image", "foreignObject", "flowRoot", "script", "video", "audio", "iframe", "canvas", "animate", "animateTransform", "animateMotion", "set")  # fmt: skip
#: Properties that change what is seen but not where a shape is.
IGNORED = ("filter", "mask", "marker-start", "marker-mid", "marker-end", "stroke-dasharray")


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


def local(element: Any) -> str:
    return element.tag[len(SVG) :] if isinstance(element.tag, str) and element.tag.startswith(SVG) else ""


def property_of(e: Any, name: str) -> Optional[str]:
    found = re.search(rf"(?:^|;)\s*{name}\s*:\s*([^;]+)", e.get("style") or "")
    value: Optional[str] = found.group(1).strip() if found else e.get(name)
    return value


def _styles(root: Any) -> str:
    """All that style sheets and style attributes say."""
    sheets = [e.text or "" for e in root.iter(SVG + "style")]
    return "\n".join(re.sub(r"/\*.*?\*/", "", text, flags=re.S) for text in sheets + [e.get("style") or "" for e in root.iter()])


def refuse_unknown(path: str, root: Any) -> None:
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
        return by_id.get((e.get(LINK) or e.get("href") or "#")[1:])

    for e in root.iter(SVG + "use"):
        link = e.get(LINK) or e.get("href") or ""
        if not link.startswith("#"):
            raise Refusal(f"{path}: use of another file, {quoted(link)}, isn't supported")
        of = target(e)
        if of is not None and local(of) in ("svg", "symbol") and (e.get("width") or e.get("height")):
            raise Refusal(f"{path}: use with a width or height of a symbol isn't supported; unlink the clone in the drawing's editor")
    inner = {k: {of.get("id") for u in e.iter(SVG + "use") if (of := target(u)) is not None} for k, e in by_id.items()}
    try:
        graphlib.TopologicalSorter(inner).prepare()
    except graphlib.CycleError as error:
        raise Refusal(f"{path}: {quoted(error.args[1][0])} uses itself") from None


def _refuse_transparent(path: str, root: Any) -> None:
    for e in root.iter(SVG + "stop"):
        found = re.search(r"stop-opacity\s*:\s*([^;]+)", e.get("style") or "")
        opacity = (found.group(1) if found else e.get("stop-opacity") or "1").strip()
        colour = f"{e.get('style') or ''} {e.get('stop-color') or ''}"
        if opacity_of(opacity) < 1 or "transparent" in colour:
            raise Refusal(f"{path}: a gradient that is transparent somewhere has no edge there; fill the shape with a colour")


def opacity_of(text: str) -> float:
    """An opacity, 1 where it is none."""
    found = re.fullmatch(r"(\d+\.?\d*|\.\d+)(%?)", text.strip())
    return float(found.group(1)) / (100 if found.group(2) else 1) if found else 1.0


def leave_out(root: Any) -> Counter[str]:
    """Removes what no scene can hold, and counts it."""
    count: Counter[str] = collections.Counter()
    for parent in list(root.iter()):
        for child in list(parent):
            name = local(child)
            if name in _LEFT_OUT:
                count["text" if name == "flowRoot" else name] += 1
                parent.remove(child)
            elif name == "pattern":  # a shape is solid whatever its pattern is
                child.tag = SVG + "linearGradient"
                kept = child.get("id")
                child[:] = []
                child.attrib.clear()
                child.set("id", kept or "")
                xml.SubElement(child, SVG + "stop", {"stop-color": "#000"})
                count["pattern"] += 1
    text = _styles(root)
    for name in IGNORED:
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


def page_of(path: str, root: Any, options: Options) -> Page:
    size = [None if text == "auto" else text for text in (property_of(root, "width"), property_of(root, "height"))]
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
        raise Refusal(f"{path}: Inkscape before 0.92 used 90 px an inch: give --scale 2.8222222e-4, or 2.6458333e-4 if this drawing uses 96")
