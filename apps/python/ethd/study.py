"""Studies: folders that ethd-study writes. The folder's own README.md says what each column of each table means."""
import configparser
import os
from typing import Any, Iterator, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ethd.recording import Recording, ini
from ethd.table import table


class Study:
    """A study's tables as structured arrays, with SI units or the unit in the column's name, NaN where a number isn't
    defined. A table that the folder lacks is None. `plugins` as for ethd.read()."""

    taps: NDArray[Any]  #: a row a tap, training too: `valid` and `reason` say whether it counts, `part` whether it is analysed
    participants: NDArray[Any]  #: a row a participant: `analysed` says whether the taps belong to the analysis
    events: Optional[NDArray[Any]]  #: begin, consent, pauses, notes, end
    survey: Optional[NDArray[Any]]  #: a row per participant and cell
    orders: Optional[NDArray[Any]]  #: the planned order of each participant
    config: configparser.ConfigParser  #: study.ini, the protocol

    def __init__(self, folder: Union[str, "os.PathLike[str]"], plugins: bool = False):
        self.folder = os.fspath(folder)
        self._plugins = plugins
        for name in ("taps.csv", "participants.csv"):
            if not os.path.exists(self._path(name)):
                raise FileNotFoundError(f"{self.folder}: no study there that was begun: it has no {name}")
        self.taps = table(self._path("taps.csv"))
        self.participants = table(self._path("participants.csv"))
        self.events = self._table("events.csv")
        self.survey = self._table("survey.csv")
        self.orders = self._table("orders.csv")
        self.config = ini(self._path("study.ini"))

    def _path(self, *names: str) -> str:
        return os.path.join(self.folder, *names)

    def _table(self, name: str) -> Optional[NDArray[Any]]:
        return table(self._path(name)) if os.path.exists(self._path(name)) else None

    def _trial_folder(self, tap: np.void) -> str:
        return self._path("taps", f"{tap['participant']}-{int(tap['block']):02d}-{int(tap['attempt']):03d}")

    def trial(self, tap: np.void) -> Recording:
        """The recording of a row of `taps`: every tick of that tap."""
        folder = self._trial_folder(tap)
        if not os.path.exists(os.path.join(folder, "tick.npy")):
            raise FileNotFoundError(f"{folder}: that tap's ticks aren't there")
        return Recording(folder, self._plugins)

    def trials(self) -> Iterator[Tuple[np.void, Recording]]:
        """Each row of `taps` with its recording, in the table's order; taps whose ticks weren't kept are left out."""
        for tap in self.taps:
            if os.path.exists(os.path.join(self._trial_folder(tap), "tick.npy")):
                yield tap, self.trial(tap)
