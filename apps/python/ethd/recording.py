"""Recordings: folders that the programs write."""
import configparser
import os
import threading
from typing import Any, Dict, Generic, Iterator, List, Optional, Tuple, TypeVar, Union

import numpy as np
from numpy.typing import NDArray

from ethd._native import ffi, lib
from ethd.controller import SPACE_TRACE, TRACE, Controller, Space, SpaceStep, Step, is_row, surfaces_of
from ethd.errors import Error, check, text
from ethd.law import Law
from ethd_programs.files import there
from ethd_programs.npy import array_in
from ethd_programs.recording import RecordedEvent, events
from ethd_programs.table import table, words


PLUGINS = "ethd.read(folder, plugins=True)"
#: What an event does to the controller of a replay.
KINDS = {"setup": "fresh", "transition": "changed", "contact": "changed", "tracking": "changed", "set": "changed", "clear": "clear", "heat": "hot", "learned": "taught",
         "thinned": "", "lost": "", "fault": "", "clock": "", "end": ""}


def ini(path: str) -> configparser.ConfigParser:
    """A file of sections and keys, as it stands: nothing of it is checked, opened or run."""
    found = configparser.ConfigParser(inline_comment_prefixes=(";",), interpolation=None, strict=False)
    if there(*os.path.split(path)):
        try:
            found.read_string(words(path), path)
        except configparser.Error as e:
            raise ValueError(f"{path}: {' '.join(str(e).split())}") from None
    return found


_Front = TypeVar("_Front", Controller, Space)
_Result = TypeVar("_Result", Step, SpaceStep)


class _Recorded(Generic[_Front, _Result]):
    """A recording's folder. `tick` is mapped from its file, not copied; a file that the folder lacks is None. Reading runs
    nothing that the folder brings along: its plug-ins are opened by controller(), replay() and verify(), and only with
    plugins=True."""

    tick: NDArray[Any]  #: a row a tick, of the dtype ethd.TRACE; ethd.UNITS has the unit of each field, positions are in R_0
    truth: Optional[NDArray[Any]]  #: of a simulation, a row a tick: what was true (m, m/s, N; R_0)
    taps: Optional[NDArray[Any]]  #: a row a tap, NaN where a number isn't defined; of a study's tap its own
    events: List[RecordedEvent]
    config: configparser.ConfigParser  #: config.ini
    _front: Any  #: its controller's class

    def __init__(self, folder: str, plugins: bool = False):
        self.folder = folder
        self._plugins = plugins
        self.tick = array_in(folder, "tick.npy")
        self.truth = self._array("truth.npy")
        self.taps = table(os.path.join(folder, "taps.csv")) if there(folder, "taps.csv") else None
        self.events = events(folder)
        self.config = ini(os.path.join(folder, "config.ini"))

    def _array(self, name: str) -> Optional[NDArray[Any]]:
        return array_in(self.folder, name) if there(self.folder, name) else None

    def _fits(self) -> bool:
        """Whether rows are of this version's columns, or an earlier one's."""
        raise NotImplementedError

    def _step(self, c: Any, row: np.void) -> Any:
        return c.step(row)

    def _open(self) -> Any:
        if not self._fits():
            raise ValueError(f"{self.folder}/tick.npy: other columns than those of this version of libethd: it can't be replayed")
        if not there(self.folder, "events.csv"):
            raise FileNotFoundError(f"{self.folder}/events.csv: No such file, so what happened is unknown: it can't be replayed")
        self._refuse_missing([e for e in self.events if e.row == 0])
        try:
            return self._front(os.path.join(self.folder, "config.ini"), self._plugins)
        except Error as e:
            raise Error(e.status, str(e).replace("plugins=True lets", PLUGINS + " lets")) from None

    def _refuse_missing(self, events: List[RecordedEvent]) -> None:
        """What was learned in ticks that aren't there, nobody knows: what comes after them can't be replayed."""
        for e in events:
            if e.kind in ("thinned", "lost"):
                raise Error(lib.ETHD_E_UNFINISHED, f"{self.folder}: from tick {e.row} on it can't be replayed: {e.detail}")

    def controller(self) -> _Front:
        """A controller set up as the recording began: its configuration, then the events before row 0. Error: ticks are
        missing from the beginning, as in a recording of every tenth."""
        c: _Front = self._open()
        _Replay(c).before([e for e in self.events if e.row == 0], first=True)
        return c

    def replay(self, law: Optional[Law] = None) -> Iterator[Tuple[np.void, _Result]]:
        """Yields each recorded row with the library's present result for it; the recording's events act at their rows, and in
        space the surfaces are those that were recorded. With `law` that one rules in the place of whatever law of its kind was
        recorded, with the recording's values for parameters of the same name. The recorded device doesn't react to it. Error:
        ticks are missing before this row."""
        c = self._open()
        replay, rows = _Replay(c, law), self._by_row()
        for i in range(len(self.tick)):
            self._refuse_missing(rows.get(i, []))
            if i == 0 or i in rows:
                replay.before(rows.get(i, []), first=i == 0)
            yield self.tick[i], self._step(c, self.tick[i])
            c.events()

    def _by_row(self) -> Dict[int, List[RecordedEvent]]:
        rows: Dict[int, List[RecordedEvent]] = {}
        for e in self.events:
            rows.setdefault(e.row, []).append(e)
        return rows

    def verify(self) -> str:
        """Replays the folder within the library and returns its sentence. Error: the first tick and field that differ. Ctrl-C
        ends it."""
        message, stop, found = text(), ffi.new("int *"), []

        def run() -> None:
            found.append(lib.ethd_recording_verify(os.fsencode(self.folder), self._plugins, stop, message))

        work = threading.Thread(target=run)  # this one waits, and takes signals meanwhile
        work.start()
        try:
            while work.is_alive():
                work.join(0.1)
        finally:
            stop[0] = 1
            work.join()
        check(found[0], message, plugins=PLUGINS)
        return str(ffi.string(message).decode())


class Recording(_Recorded[Controller, Step]):
    __doc__ = _Recorded.__doc__
    _front = Controller

    def _fits(self) -> bool:
        return is_row(self.tick.dtype)


class SpaceRecording(_Recorded[Space, SpaceStep]):
    """A Recording of the front in space: its rows are of the dtype ethd.SPACE_TRACE, with the units of ethd.SPACE_UNITS, and its
    controller is an ethd.Space."""

    _front = Space

    def _fits(self) -> bool:
        return self.tick.dtype == SPACE_TRACE

    def _step(self, c: Any, row: np.void) -> Any:
        return c.step(row, surfaces_of(row))


class _Replay:
    """A row's events make one setup: with setup or start among them a fresh controller begins with it, else it is posted."""

    def __init__(self, controller: Union[Controller, Space], law: Optional[Law] = None):
        self.c = controller
        self.law = law
        self.kinds = {kind: does for kind, does in KINDS.items() if does not in ("hot", "taught") or not controller._is_space}
        self.recorded = controller._copy(controller._setup[0])  # which has the recorded law, whatever rules in its place
        self.heat = ffi.new("double[2]")
        self.learned = ffi.new("double[]", TRACE["learnt"].shape[0])

    def before(self, events: List[RecordedEvent], first: bool) -> None:
        c, done = self.c, {"fresh"} if first else set()
        for e in events:
            done.add(self._take(e, self.recorded))
        setup = c._copy(self.recorded[0])
        if self.law:
            c._rule(setup, self.law)
        if done & {"fresh", "warm"} and not (done <= {"warm", "hot", "taught", ""} and not first):
            c._setup = setup
            c._create()
        elif "warm" in done:
            c._call("reset" if c._is_space else "restart", c._control)
        elif "changed" in done:
            c._post(setup)
        if "clear" in done:
            c.clear()
        if "hot" in done:
            lib.ethd_control_set_heat(c._control, self.heat)
        if "taught" in done:
            lib.ethd_control_set_memory(c._control, self.learned)

    def _take(self, e: RecordedEvent, setup: Any) -> str:
        if e.kind == "setup":
            setup[0] = getattr(self.c._config.c, self.c._member)
        if e.kind in ("setup", "transition", "contact", "tracking"):
            self.c._change(setup, ("transition" if e.kind == "setup" else e.kind) + ".law", e.detail)
        elif e.kind == "set":
            key, _, value = e.detail.partition(" ")
            self.c._change(setup, key, value)
        elif e.kind == "heat" and "heat" in self.kinds:
            self._numbers(e, self.heat)
        elif e.kind == "learned" and "learned" in self.kinds:
            self._numbers(e, self.learned)
        elif e.kind == "start":
            return "warm" if e.detail == "enabled" else "fresh"
        elif e.kind not in self.kinds:
            raise ValueError(f"events.csv: row {e.row}: found the kind {e.kind!r}; {', '.join(self.kinds)}, start are allowed")
        return KINDS[e.kind]

    def _numbers(self, e: RecordedEvent, to: Any) -> None:
        try:
            numbers = [float(word) for word in e.detail.split(" ")]
        except ValueError:
            numbers = []
        if len(numbers) != len(to) or not np.isfinite(numbers).all():
            raise ValueError(f"events.csv: row {e.row}: {e.kind}: found {e.detail!r}, {len(to)} numbers are allowed")
        for i, number in enumerate(numbers):
            to[i] = number
