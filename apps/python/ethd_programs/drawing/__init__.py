"""ethd-scene convert: a drawing, SVG or DXF, as a scene."""
import math
import os
import re
from typing import Optional, Sequence

from ethd_programs.cli import DONE, FAILED, Parser, Refusal, quoted, run, tell

MORE = """
A filled shape becomes a solid; a shape with only a stroke becomes a thin wall, whatever the stroke's width. A filled shape with holes becomes walls. Text, images and other unsupported elements are skipped, and their number is printed. y is mirrored in SVG, so that it points up.

Example:
  ethd-scene convert --in drawing.svg --out walls.scene --origin 0.1,0.2
"""
_METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}


def _number(option: str, text: Optional[str], least: float) -> Optional[float]:
    if text is None:
        return None
    plain = re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", text)
    value = float(text) if plain else math.nan
    if not least <= value <= 1e6:
        raise Refusal(f"{option}: found {quoted(text)}, a number from {least:g} to 1e6 is allowed")
    return value


def _main(arguments: Sequence[str]) -> int:
    parser = Parser("ethd-scene", "convert", "Makes a scene of a drawing.", MORE)
    parser.add_argument("-i", "--in", metavar="IN", dest="drawing", help="a drawing, .svg or .dxf")
    parser.add_argument("-o", "--out", metavar="OUT", help="the scene")
    parser.add_argument("-l", "--scale", metavar="M", help="SVG: m per user unit (default: by width, height and viewBox, 96 px an inch)")
    parser.add_argument("-u", "--units", metavar="UNIT", help="DXF: m, cm, mm, in or ft, where the file doesn't say its unit")
    parser.add_argument("-O", "--origin", metavar="X,Y", help="where the page's lower left corner, or DXF's origin, goes, m (default: 0,0)")
    parser.add_argument("-t", "--tolerance", metavar="M", help="how far an edge may be from its curve, m (default: 1e-5)")
    parser.add_argument("-g", "--page", metavar="solid|background", help="what a filled shape is that covers the page")
    parser.add_argument("-p", "--plot", metavar="OUT.png", help="draw drawing and scene side by side")
    parser.finish()
    o = parser.parse_args(arguments)
    if not o.drawing or not o.out:
        parser.error("convert needs --in and --out")
    if o.page not in (None, "solid", "background"):
        raise Refusal(f"--page: found {quoted(o.page)}, solid or background is allowed")
    if o.units not in (None, *_METRES):
        raise Refusal(f"--units: found {quoted(o.units)}, {', '.join(_METRES)} are allowed")
    if o.plot is not None and not o.plot.endswith(".png"):
        raise Refusal(f"--plot: found {quoted(o.plot)}, a file .png is needed")
    places = (o.origin or "0,0").split(",")
    if len(places) != 2:
        raise Refusal(f"--origin: found {quoted(o.origin)}, X,Y is allowed")
    if o.plot is not None and os.path.exists(o.out) and os.path.exists(o.plot) and os.path.samefile(o.out, o.plot):
        raise Refusal(f"--plot: {o.plot} is the file of --out, too; another name is needed")
    origin = tuple(_number("--origin", word, -1e6) or 0.0 for word in places)
    tolerance = _number("--tolerance", o.tolerance, 1e-9)
    scale = _number("--scale", o.scale, 1e-9)
    try:
        return _convert(o.drawing, o.out, o.plot, dict(tolerance=tolerance or 1e-5, scale=scale, origin=origin, page=o.page, units=o.units))
    except ModuleNotFoundError as e:
        raise Refusal(f"the Python package {e.name} is missing, which reads drawings (Debian: python3-{e.name})", FAILED) from None


def _convert(drawing: str, out: str, plot: Optional[str], options: "dict[str, object]") -> int:
    from ethd_programs.drawing import svg
    from ethd_programs.drawing.librsvg import rsvg
    from ethd_programs.drawing.scene import picture
    from ethd_programs.drawing.svg_source import Options
    from ethd_programs.files import Output, plain_file

    is_dxf = drawing.lower().endswith(".dxf")
    if not is_dxf and not drawing.lower().endswith(".svg"):
        raise Refusal(f"--in: found {quoted(drawing)}, a file .svg, .dxf or .scene is needed")
    if is_dxf and (options["scale"] is not None or options["page"] is not None):
        raise Refusal(f"--scale and --page are for SVG, {drawing} is none")
    if not is_dxf and options["units"] is not None:
        raise Refusal(f"--units is for DXF, {drawing} is none")
    for option, other in (("--out", out), ("--plot", plot)):
        if other and os.path.exists(other) and os.path.isfile(other) and os.path.exists(drawing) and os.path.samefile(other, drawing):
            raise Refusal(f"{option}: {other} is the file of --in, which is only read; another name is needed")
    data = plain_file(drawing, 1 << 30)
    if is_dxf:
        from ethd_programs.drawing import dxf

        found = dxf.read(drawing, data, Options(**options), _METRES)  # type: ignore[arg-type]
    else:
        found = svg.read(drawing, data, Options(**options))  # type: ignore[arg-type]
    if plot:
        done = rsvg(["-b", "white", "-w", "900", "-h", "900", "-a"], found.original)
        shown = picture(found.scene, done.stdout, found.frame)
    with Output(out) as file:
        file.write(found.scene.text().encode())
    if plot:
        with Output(plot) as file:
            file.write(shown)
    tell(f"{out}: {found.scene.counts()}, of {drawing}")
    for note in found.scene.notes:
        tell(f"  {note}")
    return DONE


def main(arguments: Optional[Sequence[str]] = None) -> int:
    return run("ethd-scene", _main, arguments)
