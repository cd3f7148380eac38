"""Recordings: folders that the programs write."""
import configparser
import csv
import os
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ethd._native import ffi, lib
from ethd.controller import TRACE, Controller, Step
from ethd.errors import Error, check, text


class RecordedEvent(NamedTuple):
    """A line of events.csv; the event comes before row `row` of tick."""

    row: int
    kind: str  #: setup, start, transition, set, clear, heat, fault
    detail: str


class Recording:
    """A recording's folder. `tick` is mapped from its file, not copied; a file that the folder lacks is None."""

    def __init__(self, folder: str, plugins: bool = False):
        self.folder = folder
        self._plugins = plugins
        self.tick: NDArray[Any] = np.load(os.path.join(folder, "tick.npy"), mmap_mode="r")
        self.truth: Optional[NDArray[Any]] = self._array("truth.npy")
        self.taps: Optional[NDArray[Any]] = self._table("taps.csv")
        self.events = self._events()
        self.config = configparser.ConfigParser(inline_comment_prefixes=(";",), interpolation=None, strict=False)
        self.config.read(os.path.join(folder, "config.ini"), encoding="utf-8")

    def _array(self, name: str) -> Optional[NDArray[Any]]:
        path = os.path.join(self.folder, name)
        return np.load(path, mmap_mode="r") if os.path.exists(path) else None

    def _table(self, name: str) -> Optional[NDArray[Any]]:
        path = os.path.join(self.folder, name)
        if not os.path.exists(path):
            return None
        return np.atleast_1d(np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8"))

    def _events(self) -> List[RecordedEvent]:
        path = os.path.join(self.folder, "events.csv")
        if not os.path.exists(path):
            return []
        with open(path, encoding="utf-8", newline="") as file:
            return [RecordedEvent(int(e["row"]), e["kind"], e["detail"]) for e in csv.DictReader(file)]

    def _open(self) -> Controller:
        if self.tick.dtype != TRACE:
            raise ValueError(f"{self.folder}/tick.npy: other columns than those of this version of libethd: it can't be replayed")
        try:
            return Controller(os.path.join(self.folder, "config.ini"), self._plugins)
        except Error as e: # the library names its programs' option
            raise Error(e.status, str(e).replace("--plugins lets it run", "ethd.read(folder, plugins=True) lets it run")) from None

    def controller(self) -> Controller:
        """A controller set up as the recording began: its configuration, then the events before row 0."""
        c = self._open()
        _Replay(c).before([e for e in self.events if e.row == 0], first=True)
        return c

    def replay(self) -> Iterator[Tuple[np.void, Step]]:
        """Yields each recorded row with the library's present result for it; the recording's events act at their rows."""
        c = self._open()
        replay, rows = _Replay(c), self._by_row()
        for i in range(len(self.tick)):
            if i == 0 or i in rows:
                replay.before(rows.get(i, []), first=i == 0)
            yield self.tick[i], c.step(self.tick[i])
            c.events()

    def _by_row(self) -> Dict[int, List[RecordedEvent]]:
        rows: Dict[int, List[RecordedEvent]] = {}
        for e in self.events:
            rows.setdefault(e.row, []).append(e)
        return rows

    def verify(self) -> str:
        """Replays the folder within the library and returns its sentence. Error: the first tick and field that differ."""
        message = text()
        check(lib.ethd_recording_verify(os.fsencode(self.folder), self._plugins, message), message)
        return str(ffi.string(message).decode())


class _Replay:
    """A row's events make one setup: with setup or start among them a fresh controller begins with it, else it is posted."""

    def __init__(self, controller: Controller):
        self.c = controller
        self.heat = ffi.new("double[2]")

    def before(self, events: List[RecordedEvent], first: bool) -> None:
        c, done = self.c, {"fresh"} if first else set()
        setup = ffi.new("ethd_setup *", c._setup[0])
        for e in events:
            done.add(self._take(e, setup))
        if done & {"fresh", "warm"} and not (done <= {"warm", "hot", ""} and not first):
            c._setup = setup
            c._create()
        elif "warm" in done:
            lib.ethd_control_restart(c._control)
        elif "changed" in done:
            c._post(setup)
        if "clear" in done:
            c.clear()
        if "hot" in done:
            lib.ethd_control_heated(c._control, self.heat)

    def _take(self, e: RecordedEvent, setup: Any) -> str:
        if e.kind == "setup":
            setup[0] = self.c._config.c.setup
        if e.kind in ("setup", "transition"):
            self.c._change(setup, "transition.law", e.detail)
        elif e.kind == "set":
            self.c._change(setup, *e.detail.split(" ", 1))
        elif e.kind == "heat":
            self.heat[0], self.heat[1] = map(float, e.detail.split())
        kinds = {"setup": "fresh", "transition": "changed", "set": "changed", "clear": "clear", "heat": "hot"}
        return ("warm" if e.detail == "enabled" else "fresh") if e.kind == "start" else kinds.get(e.kind, "")


def read(folder: Union[str, "os.PathLike[str]"], plugins: bool = False) -> Recording:
    """A recording: .tick (structured array), .events, .config, .truth and .taps where there are any.

    With plugins=True the plug-ins that it names are loaded for its controllers: they are programs that run with your rights.
    """
    path = os.fspath(folder)
    if not os.path.exists(os.path.join(path, "tick.npy")):
        if os.path.exists(os.path.join(path, "study.ini")):
            raise FileNotFoundError(
                f"{path}: a study's folder, not a recording: each tap is one, in {os.path.join(path, 'taps')}; taps.csv has all figures"
            )
        raise FileNotFoundError(f"{path}: no recording there: it has no tick.npy")
    return Recording(path, plugins)
