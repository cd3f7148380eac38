"""Reads SVG. librsvg resolves style sheets, units, use, clip paths, transforms and visibility: rsvg-convert writes the drawing
as plain paths."""
import re
import xml.etree.ElementTree as xml
from typing import Counter, NamedTuple, Tuple

import numpy as np

from ethd_programs.cli import Refusal, plural, quoted
from ethd_programs.drawing.geometry import circle_of, covered, points_of
from ethd_programs.drawing.librsvg import PIXELS, Reader, rsvg, wrapped
from ethd_programs.drawing.scene import Scene
from ethd_programs.drawing.svg_source import SVG, Options, Page, leave_out, local, page_of, refuse_unknown


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
    if local(root) != "svg":
        raise Refusal(f"{path}: a drawing must begin with svg, of {SVG[1:-1]}: found {quoted(str(root.tag))}")
    refuse_unknown(path, root)
    page = page_of(path, root, options)
    left_out = leave_out(root)
    zoom = PIXELS / (3 * max(page.width, page.height))
    done = rsvg(["-f", "svg"], wrapped(root, page))
    if done.returncode:
        reason = done.stderr.decode(errors="replace").strip().split("\n")[-1]
        raise Refusal(f"{path}: librsvg can't draw it: {reason or f'rsvg-convert ended by {done.returncode}'}")
    k, (ox, oy) = page.metres, options.origin
    to_metres = np.array([[k / zoom, 0, ox - page.width * k], [0, -k / zoom, oy + 2 * page.height * k], [0, 0, 1]])
    width, height = page.width * k, page.height * k
    paper = box(ox, oy, ox + width, oy + height)
    scene, outside, across, white, pages = Scene(), 0, 0, 0, 0
    drawn = xml.fromstring(done.stdout)
    reader = Reader(drawn, to_metres, options.tolerance)
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
    scene.note_shapes(
        (scene.holes, "filled with holes: their outlines are walls"),
        (white, "filled with white: taken as solid"),
        (scene.twice, "drawn twice: kept once"),
        (outside, "outside of the page: left out"),
        (across, "beyond the page's edge: kept whole"),
        (pages if options.page == "background" else 0, "as large as the page: left out"),
        (scene.blank, "without length: left out"),
    )
