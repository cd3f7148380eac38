"""What the programs in Python share: help, refusals, exit codes."""
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from ethd_programs import cli

PROGRAM = r"""
import sys, time
from ethd_programs import cli
def main(arguments):
    parser = cli.Parser("ethd-x", "FILE", "Does it.", "More of it.\n\nExample:\n  ethd-x file")
    parser.add_argument("-c", "--count", metavar="N", help="how often, " + "and a long text that says so " * 3)
    parser.add_argument("names", nargs="*")
    parser.finish()
    names = parser.parse_args(arguments).names
    if names == ["wait"]: print("ready", flush=True); time.sleep(60)
    if names == ["bad"]: raise cli.Refusal("a\x1b[2J: bad")
    if names == ["memory"]: raise MemoryError
    print("done")
    return cli.DONE
sys.exit(cli.run("ethd-x", main))
"""


def start(*arguments: str, **options: object) -> "subprocess.Popen[str]":
    command = [sys.executable, "-c", PROGRAM, *arguments]
    return subprocess.Popen(command, text=True, stdout=options.get("stdout", subprocess.PIPE), stderr=subprocess.PIPE)


@pytest.mark.parametrize(
    "arguments, code, out, err",
    [
        (["a"], 0, "done\n", ""),
        (["bad"], 2, "", "ethd-x: a?[2J: bad\n"),
        (["memory"], 1, "", "ethd-x: no memory\n"),
        (["--none"], 2, "", "ethd-x: unrecognized arguments: --none\nTry `ethd-x --help' or `ethd-x --usage' for more information.\n"),
        (["--usage"], 0, "Usage: ethd-x [-?V] [--count=N] [--help] [--usage] [--version] FILE\n", ""),
    ],
)
def test_ends(arguments: list, code: int, out: str, err: str) -> None:
    program = start(*arguments)
    assert program.communicate() == (out, err) and program.returncode == code


def test_help_is_laid_out_as_argp_does() -> None:
    lines = start("--help").communicate()[0].splitlines()
    assert lines[:3] == ["Usage: ethd-x [OPTION...] FILE", "Does it.", ""]
    assert lines[3].startswith("  -c, --count=N              how often, and a long text")
    assert lines[4].startswith(" " * 29 + "text") or lines[4].startswith(" " * 29)
    assert max(map(len, lines)) <= 79 and "  -?, --help                 Give this help list" in lines
    assert lines[-4:] == ["More of it.", "", "Example:", "  ethd-x file"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_one_line(number: int) -> None:
    program = start("wait")
    assert program.stdout is not None and program.stdout.readline() == "ready\n"
    program.send_signal(number)
    assert program.communicate(timeout=10)[1] == "ethd-x: stopped\n" and program.returncode == 1


def test_a_full_disk_behind_stdout_is_said() -> None:
    with open("/dev/full", "w") as full:
        program = start("a", stdout=full)
    assert program.communicate()[1] == "ethd-x: standard output: No space left on device\n" and program.returncode == 1


def test_quoted() -> None:
    assert cli.quoted("a\nb\u00e9") == '"a?b?"' and len(cli.quoted("x" * 99)) == 52


def test_version_is_that_of_the_headers() -> None:
    header = Path(__file__).parents[2] / "include/ethd/ethd.h"
    launched = subprocess.run([os.environ["BUILD"] + "/bin/ethd-convert", "-V"], capture_output=True, text=True).stdout
    assert f'ETHD_VERSION "{launched.split()[1]}"' in header.read_text()
