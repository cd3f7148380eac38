"""The folder of a report: locked while it is written; its files take their places whole."""
import csv
import errno
import fcntl
import fnmatch
import io
import os
import re
import stat
from typing import Iterable, Optional, Sequence, Union

from ethd_programs.cli import Refusal
from ethd_programs.files import Output

Cell = Union[str, int, float, None]
_LOCK = ".lock"
_LINK = "is a link, which isn't followed in a folder of somebody else; a file is needed"


def _cell(cell: Cell) -> Cell:
    """None and NaN become empty, control characters spaces; csv.writer gives a float a decimal point or an exponent."""
    if cell != cell:
        return None
    return re.sub(r"[\0-\x1f]", " ", cell) if isinstance(cell, str) else cell


def harmless(words: str) -> str:
    """Words for people, which no program of ours reads back. Spreadsheets take a cell that begins with = + - @ for a
    formula, so an apostrophe is put before it unless it is a number."""
    number = re.fullmatch(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?", words)
    return f"'{words}" if words[:1] in ("=", "+", "-", "@") and words and not number else words


class ReportFolder:
    """A folder that is claimed until it is closed."""

    def __init__(self, path: str, own: Sequence[str], force: bool, received: Optional[str]):
        """Makes the folder, unless it is there, and locks it. One that holds a file of `own` (patterns) is refused unless
        `force` is set. received: the folder that it is in, which somebody else may have made; no link is followed there."""
        self.path, self._received = path, received
        try:
            if not os.path.isdir(path):
                os.mkdir(path)
            self._folder = os.open(path, os.O_RDONLY | os.O_DIRECTORY | (os.O_NOFOLLOW if received else 0))
        except OSError as e:
            raise Refusal(f"{path}: {_LINK if received and os.path.islink(path) else e.strerror}") from None
        self._lock()
        try:
            self._look(own, force)
        except Refusal:
            self.close()
            raise

    def _look(self, own: Sequence[str], force: bool) -> None:
        found = [n for n in sorted(os.listdir(self._folder)) if not n.startswith(".") and any(fnmatch.fnmatchcase(n, o) for o in own)]
        if found and not force:
            raise Refusal(f"{self.path}: holds {found[0][:80]} already; --force replaces what is there")
        for name in found if self._received else ():
            if not stat.S_ISREG(os.stat(name, dir_fd=self._folder, follow_symlinks=False).st_mode):
                raise Refusal(f"{self.path}/{name[:80]}: isn't a file; remove it first")

    def _lock(self) -> None:
        path = os.path.join(self.path, _LOCK)
        try:
            self._held = os.open(_LOCK, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK, 0o666, dir_fd=self._folder)
        except OSError as e:
            raise Refusal(f"{path}: {_LINK if e.errno == errno.ELOOP else e.strerror}") from None
        if not stat.S_ISREG(os.fstat(self._held).st_mode):
            raise Refusal(f"{path}: isn't a file; remove it")
        try:
            fcntl.flock(self._held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Refusal(f"{self.path}: another program is writing there") from None

    def close(self) -> None:
        os.unlink(_LOCK, dir_fd=self._folder)
        os.close(self._held)
        os.close(self._folder)

    def __enter__(self) -> "ReportFolder":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def file(self, name: str) -> Output:
        return Output(os.path.join(self.path, name), self._received)

    def write(self, name: str, data: bytes) -> None:
        with self.file(name) as file:
            file.write(data)

    def table(self, name: str, header: str, rows: Iterable[Sequence[Cell]]) -> None:
        text = io.StringIO()
        text.write(header + "\n")
        csv.writer(text, lineterminator="\n").writerows(map(_cell, row) for row in rows)
        self.write(name, text.getvalue().encode())
