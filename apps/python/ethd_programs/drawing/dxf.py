"""Reads DXF by ezdxf: what stands in the model space of visible layers. Lines are walls, hatches and solids are solid."""
import collections
import io
from typing import Any, Counter, Dict, Iterator

import numpy as np

from ethd_programs.cli import Refusal
from ethd_programs.drawing.geometry import apart, covered
from ethd_programs.drawing.scene import Scene
from ethd_programs.drawing.svg import Result
from ethd_programs.drawing.svg_source import Options

_HEADER = {1: 0.0254, 2: 0.3048, 3: 1609.344, 4: 1e-3, 5: 1e-2, 6: 1.0, 7: 1e3, 8: 2.54e-8, 9: 2.54e-5, 10: 0.9144, 13: 1e-6, 14: 0.1}
_SOLID = ("HATCH", "MPOLYGON", "SOLID", "TRACE")
_DRAWN = ("LINE", "LWPOLYLINE", "POLYLINE", "CIRCLE", "ARC", "ELLIPSE", "SPLINE")


def _entities(entities: Any, doc: Any, left_out: Counter[str], depth: int = 0) -> Iterator[Any]:
    for e in entities:
        kind = e.dxftype()
        if kind not in ("INSERT", *_DRAWN, *_SOLID):
            left_out[kind] += 1
            continue
        name = e.dxf.get("layer", "0")
        layer = doc.layers.get(name) if doc.layers.has_entry(name) else None
        if e.dxf.get("invisible", 0) or (layer is not None and (layer.is_off() or layer.is_frozen())):
            left_out["hidden"] += 1
        elif kind != "INSERT":
            yield e
        elif depth < 20:
            yield from _entities(e.virtual_entities(), doc, left_out, depth + 1)
        else:
            left_out["block within blocks"] += 1


def _flat(path: Any, tolerance: float, k: float, origin: Any) -> Any:
    points = np.array([(p.x, p.y) for p in path.flattening(tolerance / k, segments=4)]).reshape(-1, 2) * k + origin
    return apart(points) if len(points) else points


def read(path: str, data: bytes, options: Options, units: Dict[str, float]) -> Result:
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError
    from ezdxf.path import from_hatch, make_path

    if data.startswith(b"AutoCAD Binary DXF"):
        raise Refusal(f"{path}: a binary DXF; save it as text (ASCII)")
    try:
        doc, _ = recover.read(io.BytesIO(data))
    except MemoryError:
        raise
    except Exception as e:  # of any kind, where a file is broken
        raise Refusal(f"{path}: no DXF that can be read: {type(e).__name__}: {e}") from None
    k = units[options.units] if options.units else _HEADER.get(doc.header.get("$INSUNITS", 0))
    if k is None:
        raise Refusal(f"{path}: no unit stands in its header; --units m, cm, mm, in or ft says it")
    scene, left_out, origin = Scene(), collections.Counter[str](), np.array(options.origin)
    deep = 0
    for entity in _entities(doc.modelspace(), doc, left_out):
        kind = entity.dxftype()
        try:
            if kind in ("HATCH", "MPOLYGON"):
                rings = [_flat(p, options.tolerance, k, origin) for p in from_hatch(entity)]
                scene.solid(covered(rings, True))
                continue
            found = make_path(entity)
        except (ValueError, TypeError, ZeroDivisionError, AttributeError, DXFError):
            left_out[kind] += 1
            continue
        deep += any(abs(p.z) * k > 1e-6 for p in found.control_vertices())
        points = _flat(found, options.tolerance, k, origin)
        closed = len(points) > 2 and np.abs(points[0] - points[-1]).max() <= 1e-8
        if closed:
            points = points[:-1]
        if not len(points):
            scene.blank += 1
        elif kind in _SOLID:
            scene.solid(covered([points], True))
        else:
            scene.wall(points, bool(closed))
    left_out["in paper space"] += sum(len(list(doc.layout(name))) for name in doc.layout_names() if name != "Model")
    if not scene.things:
        raise Refusal(f"{path}: nothing that a scene can hold stands in its model space")
    everything = np.vstack([_extent(t) for t in scene.things])
    low, high = everything.min(axis=0), everything.max(axis=0)
    say = scene.notes.append
    say(f"1 unit = {k:.9g} m; DXF's origin at {origin[0]:.9g}, {origin[1]:.9g} m; x {low[0]:.6g} to {high[0]:.6g} m, y {low[1]:.6g} to {high[1]:.6g} m;"
        f" curves within {options.tolerance:.3g} m")  # fmt: skip
    gone = [f"{n} {name}" for name, n in left_out.items() if n]
    if gone:
        say(f"left out: {', '.join(gone)}")
    scene.note_shapes((scene.holes, "filled with holes: their outlines are walls"), (deep, "away from z = 0: seen from above"), (scene.twice, "drawn twice: kept once"))
    return Result(scene, (low[0], low[1], max(high[0] - low[0], 1e-6), max(high[1] - low[1], 1e-6)), b"")


def _extent(t: Any) -> Any:
    n = t.numbers
    if t.shape == "circle":
        return np.array([[n[0] - n[2], n[1] - n[2]], [n[0] + n[2], n[1] + n[2]]])
    if t.shape == "box":
        r = float(np.hypot(n[2], n[3]))
        return np.array([[n[0] - r, n[1] - r], [n[0] + r, n[1] + r]])
    return np.array(n).reshape(-1, 2)

