"""ethd-convert: a recording as a table or as a file of messages, for other programs."""
import contextlib
import importlib.util
import os
import sys
import time
from typing import Callable, List, Optional, Sequence

from ethd_programs.cli import DONE, FAILED, Parser, Refusal, plural, run, tell

MORE = """
CSV has a column per number, with its unit (t_s, q1_rad, tau2_Nm, ...), as ethd-replay --in reads it and --out writes it, and an empty cell where a number isn't defined or wasn't measured. utc_s is the time of day, in s since 1970, where the recording knows it. MCAP has the topics /tick and /events, and leaves out such a field; the time of day is its messages' time of publication. Where the recording's time starts again, as it does with each tap, the time of both goes on.

Example:
  ethd-run --duration 10 --record session
  ethd-convert session session.csv
"""


def _arguments(arguments: Sequence[str]) -> List[str]:
    parser = Parser(
        "ethd-convert", "DIR OUT.csv|OUT.mcap", "Converts a recording to CSV, or to MCAP for PlotJuggler and Foxglove.", MORE
    )
    parser.add_argument("names", nargs="*")
    parser.finish()
    names: List[str] = parser.parse_args(arguments).names
    if len(names) < 2:
        parser.error("a recording's folder and a .csv or .mcap file are needed")
    if len(names) > 2:
        parser.error(f'"{names[2]}": a recording and a file are all it takes')
    return names


def _refuse_inputs(folder: str, out: str) -> None:
    from ethd_programs.recording import FILES

    for name in FILES:
        with contextlib.suppress(OSError):
            if os.path.samefile(os.path.join(folder, name), out):
                raise Refusal(f"{out}: is a file of the recording, which is only read; another name is needed")


def progress(out: str) -> Callable[[int, int], None]:
    """Draws a bar on stderr if that is a terminal, at most ten times a second."""
    shown = 0.0

    def draw(done: int, total: int) -> None:
        nonlocal shown
        now = time.monotonic()
        if not sys.stderr.isatty() or (done < total and now - shown < 0.1):
            return
        share = done / max(total, 1)
        bar = "" if done >= total else f"{out} [{'#' * int(40 * share):<40}] {100 * share:3.0f} %"
        print(f"\r\033[K{bar}", end="", file=sys.stderr, flush=True)
        shown = now

    return draw


def _convert(folder: str, out: str) -> str:
    from ethd_programs.recording import Ticks, events

    if out.endswith(".csv"):
        from ethd_programs.convert_csv import write
    else:
        if importlib.util.find_spec("mcap") is None:
            raise Refusal(
                "MCAP needs the Python package mcap: python3 -m venv ~/ethd-python, ~/ethd-python/bin/pip install"
                " './apps/python[mcap]', then ~/ethd-python/bin/ethd-convert",
                FAILED,
            )
        from ethd_programs.convert_mcap import write
    ticks = Ticks(folder)
    _refuse_inputs(folder, out)
    found = events(folder)
    write(ticks, found, out, folder, progress(out))
    return f"{out}: {ticks.count} tick{plural(ticks.count)}, {len(found)} event{plural(len(found))}"


def _main(arguments: Sequence[str]) -> int:
    folder, out = _arguments(arguments)
    if not out.endswith((".csv", ".mcap")) or out in (".csv", ".mcap"):
        raise Refusal(f"{out}: a name that ends in .csv or .mcap is allowed")
    try:
        tell(_convert(folder, out))
    except (ValueError, OSError) as e:  # of reading; what writing fails at is a refusal already
        raise Refusal(f"{e.filename}: {e.strerror}" if isinstance(e, OSError) else str(e)) from None
    return DONE


def main(arguments: Optional[Sequence[str]] = None) -> int:
    return run("ethd-convert", _main, arguments)
