"""Studies: folders that ethd-study writes. The folder's own README.md says what each column of each table means."""
import configparser
import glob
import os
from typing import Any, Iterator, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ethd.recording import Recording, ini
from ethd_programs.files import there
from ethd_programs.table import table


def _name(tap: np.void) -> str:
    return f"{tap['participant']}-{int(tap['block']):02d}-{int(tap['attempt']):03d}"


class Study:
    """A study's tables as structured arrays, with SI units or the unit in the column's name, NaN where a number isn't
    defined. A table that the folder lacks is None. `plugins` as for ethd.read()."""

    taps: NDArray[Any]  #: a row a tap, training too: `valid` and `reason` say whether it counts, `part` whether it is analysed
    participants: Optional[NDArray[Any]]  #: a row a participant: `analysed` says whether the taps belong to the analysis
    events: Optional[NDArray[Any]]  #: begin, consent, pauses, notes, end
    survey: Optional[NDArray[Any]]  #: a row per participant and cell
    orders: Optional[NDArray[Any]]  #: the planned order of each participant
    config: configparser.ConfigParser  #: study.ini, the protocol

    def __init__(self, folder: Union[str, "os.PathLike[str]"], plugins: bool = False):
        self.folder = os.fspath(folder)
        self._plugins = plugins
        if glob.glob(self._pattern("shard-*-of-*.sqlite")) and not there(self.folder, "taps.csv"):
            raise FileNotFoundError(f"{self.folder}: a simulation in shards: ethd-study --merge {self.folder} makes taps.csv of them")
        if not there(self.folder, "taps.csv"):
            raise FileNotFoundError(f"{self.folder}: no study there that was begun: it has no taps.csv")
        self.taps = table(self._path("taps.csv"))
        self.participants = self._table("participants.csv")
        self.events = self._table("events.csv")
        self.survey = self._table("survey.csv")
        self.orders = self._table("orders.csv")
        self.config = ini(self._path("study.ini"))
        self._workers = sorted(os.path.basename(path) for path in glob.glob(self._pattern("taps-*-of-*")))

    def _pattern(self, name: str) -> str:
        return os.path.join(glob.escape(self.folder), name)

    def _path(self, *names: str) -> str:
        return os.path.join(self.folder, *names)

    def _table(self, name: str) -> Optional[NDArray[Any]]:
        return table(self._path(name)) if there(self.folder, name) else None

    def _trial_folder(self, tap: np.void) -> Optional[str]:
        name, folders = _name(tap), ["taps"]
        if "point" in (tap.dtype.names or ()):  # of a simulation, whose workers have a folder each
            name, folders = f"{int(tap['point'])}-{name}", self._workers
        return next((self._path(folder, name) for folder in folders if there(self.folder, folder, name, "tick.npy")), None)

    def _recording(self, folder: str, tap: np.void) -> Recording:
        recording = Recording(folder, self._plugins)
        recording.taps = np.array([tap], tap.dtype)
        return recording

    def trial(self, tap: np.void) -> Recording:
        """The recording of a row of `taps`: every tick of that tap."""
        folder = self._trial_folder(tap)
        if folder is None:
            raise FileNotFoundError(f"{self.folder}: {_name(tap)}: that tap's ticks aren't there")
        return self._recording(folder, tap)

    def trials(self) -> Iterator[Tuple[np.void, Recording]]:
        """Each row of `taps` with its recording, in the table's order; taps whose ticks weren't kept are left out."""
        for tap in self.taps:
            folder = self._trial_folder(tap)
            if folder is not None:
                yield tap, self._recording(folder, tap)
