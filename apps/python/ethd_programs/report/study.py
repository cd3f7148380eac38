"""Reads a study's folder: what it asked for, its tables, and the ticks of its taps.

What its study file, configuration, plant and walls mean, ethd-study says (--describe); nothing here reads them again. The
folder may be a stranger's: no link in it is followed, and only regular files are read.
"""
import json
import os
import re
import shutil
import subprocess
import sys
from itertools import islice
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

from numpy.typing import NDArray

from ethd_programs.cli import FAILED, Refusal
from ethd_programs.files import there
from ethd_programs.npy import array_in
from ethd_programs.table import named, words

Ticks = NDArray[Any]  #: a row a tick, with the columns of a recording


def study_program() -> str:
    """The path of ethd-study, which was installed with this program; from a venv, the first one on the PATH."""
    beside = os.path.join(os.path.dirname(os.path.realpath(sys.argv[0])), "ethd-study")
    found = beside if os.access(beside, os.X_OK) else shutil.which("ethd-study")
    if not found:
        raise Refusal("ethd-study: not found; it reads the study's files: install libethd's programs", FAILED)
    return found


def _ask(*arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([study_program(), *arguments], stdin=subprocess.DEVNULL, capture_output=True, errors="replace", check=False)


def _said(stderr: str) -> str:
    """What ethd-study refuses, as a sentence of our own."""
    return re.sub(r"^ethd-study: ", "", stderr.strip().split("\n")[0])


class Table:
    """A CSV file of words: one header row, cells by name. A table that isn't there has no columns."""

    def __init__(self, path: str, text: Optional[str]):
        """ValueError: the text is no table."""
        self.path, self._text = path, text
        self.names: List[str] = []
        for row in self._rows():
            self.names = self.names or row

    def _rows(self) -> Iterator[List[str]]:
        return iter(()) if self._text is None else named(self.path, self._text)

    def cells(self, *columns: str) -> Iterator[List[str]]:
        """These cells of each row; "" where a column is missing."""
        at = [self.names.index(name) if name in self.names else -1 for name in columns]
        for row in islice(self._rows(), 1, None):
            yield ["" if i < 0 else row[i] for i in at]


class Folder:
    """A study: one folder, or several stations' folders; the first one defines the protocol."""

    def __init__(self, folders: Sequence[str], plugins: bool, scratch: str):
        """scratch: a folder that isn't there yet, for what ethd-study says."""
        self.folders, self._scratch = folders, scratch
        told = _ask("--describe", *map(_path, folders), "--out", scratch, *["--plugins"] * plugins)
        if told.returncode:
            raise Refusal(_said(told.stderr), told.returncode if told.returncode > 0 else FAILED)
        self.facts: Dict[str, Any] = json.loads(words(os.path.join(scratch, "study.json")))
        self.name = str(self.facts["name"])

    def table(self, name: str) -> Table:
        """Of one folder as it stands there; of several, as ethd-study --merge would make it."""
        file = f"{name}.csv"
        path, source = os.path.join(self.folders[0], file), self.folders[0] if len(self.folders) == 1 else self._scratch
        try:
            return Table(path, words(os.path.join(source, file)) if there(source, file) else None)
        except (OSError, ValueError) as e:
            raise _refusal(e) from None

    def encounter(self, law: str) -> Optional[str]:
        """The table of a simulated encounter under this strategy; None: the study doesn't have it."""
        name = f"encounter-{law}.csv"
        return words(os.path.join(self._scratch, name)) if there(self._scratch, name) else None

    # ---- recordings: taps/P01-03-004, of worker i of n of a simulation taps-i-of-n/0-P01-03-004 ----

    def recordings(self) -> List[str]:
        """The folders that hold ticks of taps; there may be none."""
        found = []
        for folder in self.folders:
            names = sorted(n for n in os.listdir(folder) if n == "taps" or re.fullmatch(r"taps-[0-9]+-of-[0-9]+", n))
            found += [os.path.join(folder, n) for n in names]
        return found

    def ticks(self, recording: str, file: str, columns: Sequence[str]) -> Ticks:
        """tick.npy or truth.npy of a tap's recording."""
        folder = next(f for f in self.folders if recording.startswith(os.path.join(f, "")))
        path = os.path.join(recording, file)
        try:
            rows: Ticks = array_in(folder, *os.path.relpath(path, folder).split(os.sep), whole=True)
        except OSError as e:
            raise _refusal(e) from None
        except ValueError as e:
            raise Refusal(str(e), FAILED) from None
        if rows.ndim != 1 or not set(columns) <= set(rows.dtype.names or ()):
            raise Refusal(f"{path}: other columns than those of this version of libethd", FAILED)
        return rows


def check_sums(folders: Sequence[str]) -> Tuple[int, str]:
    """(files of all folders, what is wrong with the first folder that isn't as its SHA256SUMS says, else "")."""
    files = 0
    for folder in folders:
        told = _ask("--verify", _path(folder))
        if told.returncode:
            said = _said(told.stderr)
            return files, said[len(_path(folder)) :].lstrip("/: ") if said.startswith(_path(folder)) else said
        files += int(told.stdout.rsplit(": ", 1)[1].split(" ")[0])
    return files, ""


def _path(folder: str) -> str:
    """A folder's name that no program takes for an option."""
    return f"./{folder}" if folder.startswith("-") else folder


def _refusal(e: Exception) -> Refusal:
    if isinstance(e, OSError):
        return Refusal(f"{e.filename}: {e.strerror}")
    return Refusal(str(e))
