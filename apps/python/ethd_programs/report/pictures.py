"""Pictures by gnuplot, beside each other on the processor's cores.

gnuplot takes text for commands in many places, so nothing that stands in a file or on our command line reaches it but as a
string: names and words go through its standard input as quoted assignments, no shell sees them, and the scripts read data
files only.
"""
import os
import re
import subprocess
from concurrent.futures import Future, ThreadPoolExecutor
from typing import IO, Any, Dict, Optional, Set, Union

from ethd_programs.cli import FAILED, Refusal
from ethd_programs.report.output import ReportFolder
from ethd_programs.report.study import study_program


class Path(str):
    """A file's path, told from words: one that begins with < or | would be a command."""


def _string(words: str) -> str:
    """gnuplot reads nothing within '..' but the doubled quote; a line end would end the string."""
    plain = re.sub(r"[\0-\x1f]", " ", words).replace("'", "''")
    return f"'{plain}'"


def _path(path: str) -> str:
    return _string(path if path.startswith("/") else f"./{path}")


class Pictures:
    """Draws into a report's folder. Leaving it ends whatever still draws."""

    def __init__(self, output: ReportFolder):
        self._output = output
        self.pool = ThreadPoolExecutor(max_workers=max(1, len(os.sched_getaffinity(0))))
        self._running: Set["subprocess.Popen[bytes]"] = set()
        data = os.environ.get("ETHD_DATA_DIR") or os.path.join(os.path.dirname(study_program()), "../share/ethd")
        self._scripts = os.path.realpath(os.path.join(data, "plot"))
        with open(os.devnull, "wb") as nowhere:
            self._run("pngcairo", "set terminal pngcairo\n", nowhere)

    def __enter__(self) -> "Pictures":
        return self

    def __exit__(self, *_: Any) -> None:
        for process in list(self._running):
            process.terminate()
        self.pool.shutdown(wait=True, cancel_futures=True)

    def draw(self, script: str, name: str, values: Dict[str, Union[str, Path]]) -> "Future[bytes]":
        """Draws NAME by a script that came with the programs; relative paths start at the report's folder."""
        return self.pool.submit(self._draw, script, name, values)

    def _draw(self, script: str, name: str, values: Dict[str, Union[str, Path]]) -> bytes:
        path = os.path.join(self._scripts, script)
        if not os.access(path, os.R_OK):
            raise Refusal(f"{path}: No such file or directory; ETHD_DATA_DIR may name the folder it is in", FAILED)
        commands = f"cd {_path(self._output.path)}\nout = '/dev/stdout'\n"
        commands += "".join(f"{k} = {_path(v) if isinstance(v, Path) else _string(v)}\n" for k, v in values.items())
        with self._output.file(name) as picture:
            self._run(path, f"{commands}load {_string(path)}\n", picture)
            picture.seek(0)
            with open(picture.fileno(), "rb", closefd=False) as drawn:
                return drawn.read()

    def _run(self, what: str, commands: str, out: IO[bytes]) -> None:
        try:
            process = subprocess.Popen(["gnuplot", "--default-settings"], stdin=subprocess.PIPE, stdout=out, stderr=subprocess.PIPE)
        except FileNotFoundError:
            raise Refusal("gnuplot: not found; pictures need it (Debian: gnuplot-nox)", FAILED) from None
        except OSError as e:
            raise Refusal(f"gnuplot: {e.strerror}", FAILED) from None
        self._running.add(process)
        _, said = process.communicate(commands.encode())
        self._running.discard(process)
        if process.returncode:
            raise Refusal(f"gnuplot: {what}: {_last(said) or 'failed'}", FAILED)


def _last(said: bytes) -> Optional[str]:
    """gnuplot's last line says most."""
    lines = [line for line in said.decode(errors="replace").splitlines() if line.strip(" ^")]
    return lines[-1] if lines else None
