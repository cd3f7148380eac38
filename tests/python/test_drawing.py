"""Drawings as scenes: what each shape becomes, how far edges are from a curve, what is left out and said, and refusals."""
import math
import subprocess
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest
from ethd_programs import drawing
from ethd_programs.cli import Refusal
from ethd_programs.drawing import svg
from ethd_programs.drawing.svg_source import Options  # noqa: E402
from ethd_programs.drawing.geometry import arc_of, covered

NAMESPACE = "xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'"
OPEN = f"<svg {NAMESPACE} width='100mm' height='50mm' viewBox='0 0 100 50'>"


def read(body: str, **options: object) -> svg.Result:
    text = body if body.startswith("<svg") or body.startswith("<?") else OPEN + body + "</svg>"
    return svg.read("t.svg", text.encode(), Options(**options))  # type: ignore[arg-type]


def things(body: str, **options: object) -> List[Tuple[str, List[float]]]:
    """Shapes, with their numbers in mm but for angles."""
    return [(t.shape, [round(1e3 * n, 3) for n in t.numbers]) for t in read(body, **options).scene.things]


WALL = "<g fill='none' stroke='#000'>"


@pytest.mark.parametrize(
    "body, shape, numbers",
    [
        (f"{WALL}<line x1='1' y1='2' x2='30' y2='4'/></g>", "segment", [1, 48, 30, 46]),
        (f"{WALL}<polyline points='1,2 3,4,5 6.5'/></g>", "polyline", [1, 48, 3, 46, 5, 43.5]),
        (f"{WALL}<polygon points='1 2 3 4 5 2'/></g>", "polyline", [1, 48, 3, 46, 5, 48, 1, 48]),
        ("<polygon points='1 2 3 4 5 2'/>", "polygon", [1, 48, 3, 46, 5, 48]),
        ("<circle cx='10' cy='20' r='5'/>", "circle", [10, 30, 5]),
        ("<circle r='5' transform='translate(10 20) rotate(30)'/>", "circle", [10, 30, 5]),
        ("<rect x='10' y='10' width='20' height='6'/>", "box", [20, 37, 10, 3, 0]),
        ("<rect x='10' y='10' width='20' height='6' transform='rotate(30 20 13)'/>", "box", [20, 37, 10, 3, round(-1e3 * math.pi / 6, 3)]),
        ("<rect x='1' y='1' width='2' height='3' transform='matrix(1 0 1 1 0 0)'/>", "polygon", [7, 46, 5, 46, 2, 49, 4, 49]),
        (f"{WALL}<path d='m1 2 2 2-1-3'/></g>", "polyline", [1, 48, 3, 46, 2, 49]),
        ("<style>.w{fill:none;stroke:red}</style><path class='w' d='M1 2L3 4'/>", "segment", [1, 48, 3, 46]),
        ("<defs><rect id='r' width='4' height='2'/></defs><use xlink:href='#r' x='10' y='20'/>", "box", [12, 29, 2, 1, 0]),
        ("<rect x='10' y='10' width='20' height='6' style='transform:translate(5px,0)'/>", "box", [25, 37, 10, 3, 0]),
        ("<clipPath id='c'><rect x='10' width='5' height='50'/></clipPath><rect x='5' y='10' width='20' height='6' clip-path='url(#c)'/>", "box", [12.5, 37, 3, 2.5, round(1e3 * math.pi / 2, 3)]),
        ("<pattern id='p' width='1' height='1'><path d='M0 0'/></pattern><rect fill='url(#p)' x='10' y='10' width='20' height='6'/>", "box", [20, 37, 10, 3, 0]),
    ],
)  # fmt: skip
def test_shapes(body: str, shape: str, numbers: List[float]) -> None:
    ((found, values),) = things(body)
    assert found == shape
    if shape == "box" and abs(abs(numbers[4]) - 1570.796) < 0.01:
        numbers, values = numbers[:4], values[:4]
    if shape == "polygon":
        assert sorted(zip(values[::2], values[1::2])) == sorted(zip(numbers[::2], numbers[1::2]))
    elif shape == "box" and values[2] == numbers[3] != numbers[2]:
        assert values[:2] == numbers[:2] and values[2:4] == numbers[3:1:-1]
    else:
        assert values == pytest.approx(numbers, abs=5e-3)


def test_what_is_not_seen_is_no_wall() -> None:
    seen = things(
        "<rect width='4' height='4' fill='none'/><rect width='4' height='4' opacity='0'/><rect width='4' height='4' fill-opacity='0'/>"
        "<g display='none'><rect width='4' height='4'/></g><line x1='1' x2='9' y1='4' y2='4'/><circle cx='9' cy='9' r='2' visibility='hidden'/>"
        "<defs><rect width='9' height='9'/></defs><rect x='10' y='10' width='20' height='6' style='fill:none !important;stroke:#000'/>"
    )
    assert seen == [("polyline", [10, 40, 30, 40, 30, 34, 10, 34, 10, 40])]


def test_stars_and_holes() -> None:
    star = "M50 5 L65 45 L28 20 L72 20 L35 45z"
    assert [shape for shape, _ in things(f"<path d='{star}'/>")] == ["polygon"]
    held = read(f"<path fill-rule='evenodd' d='{star}'/>").scene
    assert {t.shape for t in held.things} == {"polygon"} and len(held.things) == 5
    ring = read("<path d='M10 10h20v20h-20z M15 15v10h10v-10z'/>").scene
    assert [t.shape for t in ring.things] == ["polyline", "polyline"]
    assert ring.holes == 1
    apart = things("<path d='M10 10h20v20h-20z M15 15h10v10h-10z'/>")
    assert apart == [("box", [20, 30, 10, 10, 0])]


def test_curves_are_within_the_tolerance() -> None:
    t = np.linspace(0, 1, 2001)[:, None]
    p = np.array([[10, 10], [20, 40], [40, -10], [50, 20]]) * [1e-3, -1e-3] + [0, 0.05]
    curve = (1 - t) ** 3 * p[0] + 3 * (1 - t) ** 2 * t * p[1] + 3 * (1 - t) * t**2 * p[2] + t**3 * p[3]
    turn = 2 * np.pi * t
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    ellipse = np.hstack([0.05 + 0.02 * c * np.cos(turn) - 0.008 * s * np.sin(turn), 0.025 - (0.02 * s * np.cos(turn) + 0.008 * c * np.sin(turn))])
    arc = np.hstack([0.01 + 0.02 * np.sin(turn / 6), 0.02 + 0.02 * np.cos(turn / 6)])
    from shapely.geometry import LineString, Point

    for body, truth in (
        ("<path d='M10 10C20 40 40-10 50 20'/>", curve),
        ("<ellipse cx='50' cy='25' rx='20' ry='8' transform='rotate(30 50 25)'/>", ellipse),
        (f"<path d='M10 10A20 20 0 0 1 {10 + 20 * math.sin(math.pi / 3)} {30 - 20 * math.cos(math.pi / 3)}'/>", arc),
    ):
        for tolerance in (1e-4, 1e-6):
            (thing,) = read(f"{WALL}{body}</g>", tolerance=tolerance).scene.things
            wall = LineString(np.array(thing.numbers).reshape(-1, 2))
            assert max(wall.distance(Point(*at)) for at in truth) <= tolerance + 2e-7, body


def test_a_curve_that_is_no_arc_stays() -> None:
    k = 0.5522847498
    quarter = np.array([[1, 0], [1, k], [k, 1], [0, 1]])
    found = arc_of(quarter)
    assert found is not None and np.allclose(found.centre, 0, atol=1e-9)
    assert arc_of(quarter + [[0, 0], [0, 1e-3], [0, 0], [0, 0]]) is None


def test_winding() -> None:
    square = np.array([[0, 0], [4, 0], [4, 4], [0, 4]], float)
    inner = square / 2 + 1
    assert covered([square, inner], False).area == 16 and covered([square, inner[::-1]], False).area == 12
    assert covered([square, inner], True).area == 12
    assert covered([np.array([[0, 0], [4, 4], [4, 0], [0, 4]], float)], False).area == 8


@pytest.mark.parametrize(
    "page, options, unit, place",
    [
        ("width='10in' height='5in' viewBox='0 0 100 50'", {}, 2.54e-3, (0.0254, 0.1016)),
        ("width='200' height='100'", {}, 0.0254 / 96, (0.254 / 96, 90 * 0.0254 / 96)),
        ("viewBox='-10,-20 100 50'", {"scale": 0.01}, 0.01, (0.2, 0.2)),
        ("width='100%' height='100%' viewBox='0 0 40 40'", {"scale": 1e-3}, 1e-3, (0.01, 0.03)),
        ("width='20cm' viewBox='0 0 200 70'", {"origin": (0.5, -0.25)}, 1e-3, (0.51, -0.19)),
    ],
)
def test_page(page: str, options: dict, unit: float, place: Tuple[float, float]) -> None:
    result = read(f"<svg {NAMESPACE} {page}><circle cx='10' cy='10' r='2'/></svg>", **options)
    ((shape, numbers),) = [(t.shape, t.numbers) for t in result.scene.things]
    assert shape == "circle" and numbers == pytest.approx((*place, 2 * unit), abs=2e-7)
    assert f"1 user unit = {unit:.9g} m" in result.scene.notes[0]


def test_what_is_left_out_is_counted() -> None:
    notes = "\n".join(
        read(
            "<text>a</text><image width='3' height='3'/><text>b</text><path d='M1 1h9' stroke='#000' stroke-dasharray='1 2'/><g style='filter:url(#f)'>"
            "<circle cx='9' cy='9' r='2'/><circle cx='9' cy='9' r='2'/></g><rect x='30' y='30' width='3' height='3' fill='#fff'/><rect x='-30' y='0' width='3' height='3'/>"
        ).scene.notes
    )
    for words in ("left out: 2 text, 1 image", "1 filter", "1 dash", "1 shape drawn twice: kept once", "1 shape filled with white", "1 shape outside of the page: left out"):
        assert words in notes, notes


def test_a_page_that_is_filled_is_asked_about() -> None:
    body = "<rect width='100%' height='100%' fill='white'/><circle cx='9' cy='9' r='2'/>"
    with pytest.raises(Refusal, match="a filled shape covers the whole page: --page background .* --page solid"):
        read(body)
    assert [shape for shape, _ in things(body, page="background")] == ["circle"]
    assert [shape for shape, _ in things(body, page="solid")] == ["box", "circle"]


@pytest.mark.parametrize(
    "body, words",
    [
        ("<rect width='3' height='3' transform='rotate(9)' transform-origin='1 1'/>", "transform-origin"),
        ("<symbol id='s'><circle r='2'/></symbol><use xlink:href='#s' width='9'/>", "use with a width or height of a symbol"),
        ("<g id='a'><use xlink:href='#b'/></g><g id='b'><use xlink:href='#a'/></g>", "uses itself"),
        ("<use xlink:href='other.svg#a'/>", "use of another file"),
        ("<linearGradient id='g'><stop stop-opacity='0'/></linearGradient><circle r='9' fill='url(#g)'/>", "transparent"),
        ("<style>@import 'x.css';</style>", "@import"),
        ("<style>path{fill:var(--x)}</style>", "computed values"),
        ("", "nothing that a scene can hold"),
        ("<g>", "no XML"),
        (f"<svg {NAMESPACE}/>", "--scale"),
        (f"<svg {NAMESPACE} width='1em'/>", "lengths over 0"),
        (f"<svg {NAMESPACE} width='1' height='1' viewBox='0 0 0 1'/>", "viewBox"),
        (f"<svg {NAMESPACE} width='1' height='1' viewBox='0 0 2 1' preserveAspectRatio='none'/>", "stretch"),
        ("<svg width='1' height='1'/>", "must begin with svg"),
        (f"<svg {NAMESPACE} xmlns:i='http://www.inkscape.org/namespaces/inkscape' i:version='0.48.4' width='744' height='1052'/>", "90 px an inch"),
    ],
)
def test_refusals(body: str, words: str) -> None:
    with pytest.raises(Refusal) as e:
        read(body)
    assert words in str(e.value) and str(e.value).startswith("t.svg: ") and "\n" not in str(e.value) and e.value.code == 2


def test_hostile_drawings_end_soon_and_read_nothing(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("secret")
    entities = "<!DOCTYPE svg [<!ENTITY a 'aaaaaaaaaa'>" + "".join(f"<!ENTITY {b} '{f'&{a};' * 10}'>" for a, b in zip("abcdefghi", "bcdefghij")) + "]>"
    outside = f"<!DOCTYPE svg [<!ENTITY x SYSTEM 'file://{tmp_path}/secret'>]>"
    for text in (
        f"{entities}<svg {NAMESPACE} width='9' height='9'><path d='&j;'/></svg>",
        f"{outside}<svg {NAMESPACE} width='9' height='9'><title>&x;</title></svg>",
        OPEN + "<g>" * 100000 + "</g>" * 100000 + "</svg>",
    ):
        with pytest.raises(Refusal):
            svg.read("t.svg", text.encode(), Options())


@pytest.mark.parametrize("seed", range(40))
def test_broken_drawings_are_read_or_refused(seed: int) -> None:
    text = bytearray((OPEN + "<g fill='none' stroke='#000' transform='rotate(30)'><path d='M1 1h5v5z m2 2q3 4 5 6t3-2'/></g><circle cx='9' r='2'/></svg>").encode())
    draw = np.random.default_rng(seed)
    for _ in range(3):
        at = int(draw.integers(len(OPEN), len(text)))
        text[at : at + int(draw.integers(3))] = bytes(draw.choice([b"'", b"<", b"e9", b"-", b"0", b"z", b"A", b"/>", b"&lt;", b"1e308"]))
    try:
        found = svg.read("t.svg", bytes(text), Options(tolerance=1e-3))
    except Refusal as e:
        assert "\n" not in str(e)
    else:
        assert all(math.isfinite(n) for t in found.scene.things for n in t.numbers)


# ---- DXF, and the program ----


def dxf(path: Path, units: int) -> None:
    import ezdxf

    doc = ezdxf.new()
    doc.header["$INSUNITS"] = units
    space = doc.modelspace()
    space.add_line((0, 0), (100, 0))
    space.add_circle((50, 50), 20)
    space.add_lwpolyline([(0, 0, 0), (10, 0, 1), (10, 10, 0)], format="xyb", close=True)
    space.add_text("a door")
    hatch = space.add_hatch()
    hatch.paths.add_polyline_path([(60, 0), (80, 0), (80, 10), (60, 10)], is_closed=True)
    doc.layers.add("off").off()
    space.add_line((0, 0), (7, 7), dxfattribs={"layer": "off"})
    doc.saveas(path)


def test_dxf(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "room.dxf", tmp_path / "room.scene"
    dxf(path, 4)
    assert drawing.main(["--in", str(path), "--out", str(out), "--plot", str(tmp_path / "room.png")]) == 0
    lines = out.read_text().splitlines()
    assert "segment 0 0 0.1 0" in lines and "box 0.07 0.005 0.01 0.005 0" in lines and len(lines) == 4
    circle = np.array([line.split()[1:] for line in lines if line.startswith("polyline")][0], float).reshape(-1, 2)
    assert np.abs(np.hypot(*(circle - 0.05).T) - 0.02).max() < 2e-5
    said = capsys.readouterr().out
    assert "1 unit = 0.001 m" in said and "left out: 1 TEXT, 1 hidden" in said
    assert (tmp_path / "room.png").read_bytes()[:4] == b"\x89PNG"
    dxf(path, 0)
    assert drawing.main(["--in", str(path), "--out", str(out)]) == 2
    assert "--units" in capsys.readouterr().err
    assert drawing.main(["--in", str(path), "--out", str(out), "--units", "cm"]) == 0
    assert "segment 0 0 1 0" in out.read_text()
    path.write_text("  0\nSECTION\n  2\nnonsense")
    assert drawing.main(["--in", str(path), "--out", str(out)]) == 2
    assert "segment 0 0 1 0" in out.read_text()


def test_pictures_show_drawing_and_scene(tmp_path: Path) -> None:
    (tmp_path / "a.svg").write_text(OPEN + "<circle cx='50' cy='25' r='20'/></svg>")
    assert drawing.main(["--in", str(tmp_path / "a.svg"), "--out", str(tmp_path / "a.scene"), "--plot", str(tmp_path / "a.png")]) == 0
    shown = subprocess.run(["rsvg-convert", "--version"], capture_output=True).returncode
    assert shown == 0 and (tmp_path / "a.png").stat().st_size > 2000
