"""ethd-report: a study's figures, tables and page."""
import importlib.util
import os
import tempfile
from typing import Any, Optional, Sequence

from ethd_programs.cli import DONE, FAILED, Parser, Refusal, quoted, run, tell

_STATIONS = 1000  # that are reported on together at most
_POINTS = 100000
_MORE = """
DIR is a folder of ethd-study, of a session or a simulation; several are stations of one study, with participants of their own. The first one's report/ gets report.html, which needs no other file, and the pictures and tidy CSV files behind it. Drawing needs gnuplot.

Examples:
  ethd-report session
  ethd-report left-room right-room --out report
  ethd-report session --beside crowd --tap P02-06-004
  ethd-report crowd --power
"""


def _arguments(arguments: Sequence[str]) -> Any:
    parser = Parser("ethd-report", "DIR...", "Counts and draws the taps of a study: traces of taps, states and beta, box plots, Table 1 beside "
                    "the paper's, delays between sight and touch, reasons, the survey, and strategies compared within participants.", _MORE)
    parser.add_argument("folders", nargs="*")
    parser.add_argument("--beside", metavar="DIR", help="show the taps of another folder beside this one's")
    parser.add_argument("--force", action="store_true", help="replace a report that is there")
    parser.add_argument("-o", "--out", metavar="DIR", help="where the report goes (default: report, in the study's folder)")
    parser.add_argument("--plugins", action="store_true", help="run the plugins that the folder's configuration names")
    parser.add_argument("--point", metavar="K", default="0", help="point of a grid that is shown in full (0)")
    parser.add_argument("--power", action="store_true", help="instead of a report, print how many participants show the study's primary outcomes, "
                        "if people differ as these simulated ones do")
    parser.add_argument("--seed", metavar="S", default="1", help="seed of the bootstrap (1)")
    parser.add_argument("--tap", metavar="NAME", help="draw this tap (P02-06-004), not the typical one of each cell")
    parser.finish()
    arg = parser.parse_intermixed_args(arguments)
    if not arg.folders:
        parser.error("DIR is needed")
    if len(arg.folders) > _STATIONS:
        parser.error(f'"{arg.folders[_STATIONS]}": {_STATIONS} folders are allowed')
    arg.point, arg.seed = _whole("--point", arg.point, 0, _POINTS), _whole("--seed", arg.seed, 0, 2**64 - 1)
    return arg


def _whole(option: str, text: str, low: int, high: int) -> int:
    if not (text.isascii() and text.isdigit() and low <= int(text) <= high):
        raise Refusal(f"{option}: found {quoted(text)}, a whole number from {low} to {high} is allowed")
    return int(text)


def _print_power(arg: Any, scratch: str) -> int:
    from ethd_programs.report.primary import print_power
    from ethd_programs.report.study import Folder
    from ethd_programs.report.taps import of_folder

    folder = Folder(arg.folders, arg.plugins, os.path.join(scratch, "study"))
    if not folder.facts["primary"]:
        raise Refusal(f"{arg.folders[0]}: its study file declares no primary outcomes ([outcomes] primary = d_max:smooth-offset:high)")
    print_power(folder.name, folder.facts["primary"], of_folder(folder, arg.point)[0][arg.point])
    return DONE


def _report(arg: Any, scratch: str) -> int:
    from ethd_programs.report import comparisons, figures, primary, survey, taps, traces, words
    from ethd_programs.report.output import ReportFolder
    from ethd_programs.report.page import Page
    from ethd_programs.report.pictures import Pictures
    from ethd_programs.report.report import Report
    from ethd_programs.report.study import Folder, check_sums

    sections = (primary.primary, comparisons.table1, comparisons.claims, figures.boxes, figures.reasons, figures.validity, comparisons.pairs,
                comparisons.interaction, survey.survey, traces.forces, traces.traces, traces.encounter, figures.tidy, figures.grid)
    folder = Folder(arg.folders, arg.plugins, os.path.join(scratch, "study"))
    points, absent = taps.of_folder(folder, arg.point)
    beside, beside_taps = None, None
    if arg.beside is not None:
        beside = Folder([arg.beside], arg.plugins, os.path.join(scratch, "beside"))
        beside_taps = taps.of_folder(beside, 0)[0][0]
    received = arg.folders[0] if arg.out is None else None
    out = os.path.join(arg.folders[0], "report") if arg.out is None else arg.out
    if os.path.exists(out) and any(os.path.samefile(out, f) for f in arg.folders):
        raise Refusal(f"--out: {out} is the study's own folder; another one is needed")
    with ReportFolder(out, ("report.html", "*.csv", "*.png"), arg.force, received) as output, Pictures(output) as pictures:
        with output.file("report.html") as file:
            r = Report(folder, output, pictures, points, arg.point, len(absent), folder.table("events"), folder.table("survey"), beside_taps,
                       beside.name if beside else "", arg.tap, arg.seed)
            sums = pictures.pool.submit(check_sums, arg.folders)
            for section in sections:
                section(r)
            body, r.page = r.page, Page()  # the head counts what the sections found
            words.head(r, body)
            r.page.add(body)
            words.methods(r)
            words.foot(r, sums.result())
            file.write(r.page.whole(f"Tapping study: {folder.name}"))
    tell(os.path.join(out, "report.html"))
    return DONE


def _main(arguments: Sequence[str]) -> int:
    arg = _arguments(arguments)
    for package in ("numpy", "scipy"):
        if importlib.util.find_spec(package) is None:
            raise Refusal(f"{package}: no such Python package; reports need it (Debian: python3-{package}; pip: libethd's extra [report])", FAILED)
    try:
        with tempfile.TemporaryDirectory(prefix="ethd-report-") as scratch:
            return (_print_power if arg.power else _report)(arg, scratch)
    except OSError as e:
        raise Refusal(f"{e.filename or 'ethd-report'}: {e.strerror}", FAILED) from None


def main(arguments: Optional[Sequence[str]] = None) -> int:
    return run("ethd-report", _main, arguments)
