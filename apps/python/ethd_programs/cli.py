"""What the programs share with those in C: the same --help, one-line refusals, exit codes, and one line at Ctrl-C.

Exit codes: 0 done, 1 the job failed, 2 wrong usage or bad input (apps/cli/cli.h).
"""
import argparse
import fcntl
import os
import re
import signal
import sys
import textwrap
from typing import Callable, List, NoReturn, Optional, Sequence

DONE, FAILED, INPUT = 0, 1, 2


class Refusal(Exception):
    """Ends the program with one line on stderr."""

    def __init__(self, message: str, code: int = INPUT):
        super().__init__(message)
        self.code = code


def plural(count: int) -> str:
    return "" if count == 1 else "s"


def quoted(word: str) -> str:
    """A word of the input for a message: cut to fit, with ? for all but printable ASCII."""
    plain = re.sub(r"[^ -~]", "?", word)
    return f'"{plain}"' if len(plain) <= 50 else f'"{plain[:47]}..."'


def _plain(text: str) -> str:
    """Text of names and files as one line that no terminal obeys."""
    return "".join(c if c.isprintable() else "?" for c in text)


def say(program: str, message: str) -> None:
    """Prints one line on stderr."""
    print(f"{program}: {_plain(message)}", file=sys.stderr)


def tell(line: str) -> None:
    """Prints one line on stdout."""
    print(_plain(line) if sys.stdout.isatty() else line)


# ---- help ----


class Parser(argparse.ArgumentParser):
    """Prints its help as the C programs do (argp). Groups and subcommands aren't used."""

    def __init__(self, program: str, takes: str, first: str, more: str):
        """`takes` names the arguments, `first` says what the program does, `more` stands below the options: paragraphs
        are wrapped, and lines that begin with two spaces stand as they are."""
        super().__init__(prog=program, add_help=False)
        self.takes, self.first, self.more = takes, first, more

    def finish(self) -> None:
        """Adds the options that every program has, as the last ones."""
        self.add_argument("-?", "--help", action="help", help="Give this help list")
        self.add_argument("--usage", action=_Usage, nargs=0, help="Give a short usage message")
        self.add_argument("-V", "--version", action=_Version, nargs=0, help="Print program version")

    def format_usage(self) -> str:
        short = "".join(o[1] for a in self._actions if not a.metavar for o in a.option_strings if len(o) == 2)
        parts = [f"[-{short}]"]
        for action in self._actions:
            if action.option_strings:
                takes = f"={action.metavar}" if action.metavar else ""
                parts.append(f"[{action.option_strings[-1]}{takes}]")
        return textwrap.fill(f"Usage: {self.prog} {' '.join(parts)} {self.takes}", _margin(), subsequent_indent=" " * 12) + "\n"

    def format_help(self) -> str:
        margin = _margin()
        lines = [f"Usage: {self.prog} [OPTION...] {self.takes}", *textwrap.wrap(self.first, margin), ""]
        for action in self._actions:
            if action.option_strings:
                lines.append(_option(action, margin))
        for paragraph in self.more.strip().split("\n\n"):
            lines.append("")
            for line in paragraph.split("\n"):
                lines += [line] if line.startswith("  ") else textwrap.wrap(line, margin)
        return "\n".join(lines) + "\n"

    def error(self, message: str) -> NoReturn:
        say(self.prog, message)
        print(f"Try `{self.prog} --help' or `{self.prog} --usage' for more information.", file=sys.stderr)
        raise SystemExit(INPUT)


def _margin() -> int:
    """The right margin; ARGP_HELP_FMT=rmargin=N sets it, as for argp."""
    found = re.search(r"\brmargin=(\d+)", os.environ.get("ARGP_HELP_FMT", ""))
    return int(found.group(1)) if found else 79


def _option(action: argparse.Action, margin: int) -> str:
    names = ", ".join(action.option_strings) if len(action.option_strings) > 1 else f"    {action.option_strings[0]}"
    left, indent = f"  {names}{'=' + str(action.metavar) if action.metavar else ''}", " " * 29
    words = textwrap.fill(action.help or "", margin, initial_indent=indent, subsequent_indent=indent)
    return f"{left}\n{words}" if len(left) > 27 else left + words[len(left) :]


class _Usage(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        print(parser.format_usage(), end="")
        raise SystemExit(DONE)


class _Version(argparse.Action):
    def __call__(self, *_: object) -> None:
        print(f"libethd {_version()}")
        raise SystemExit(DONE)


def _version() -> str:
    """In a build and where make install put it, a file beside this one says it; where pip did, pip knows."""
    try:
        with open(os.path.join(os.path.dirname(__file__), "VERSION")) as file:
            return file.read().strip()
    except FileNotFoundError:
        from importlib.metadata import version

        return version("ethd")


# ---- beginning and end ----


def _keep_streams() -> None:
    """Keeps numbers 0 to 2 from files of ours, into which standard output would go then."""
    for descriptor in range(3):
        try:
            fcntl.fcntl(descriptor, fcntl.F_GETFD)
        except OSError:
            os.open("/", os.O_PATH | os.O_CLOEXEC)


def _on_signal(number: int, _: object) -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # a second one ends the program at once
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    raise KeyboardInterrupt


def _catch_signals() -> None:
    """What is ignored when the program starts stays ignored. A reader of our output that goes away ends the program."""
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _on_signal)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)


def _unwritable(program: str, e: OSError) -> int:
    say(program, f"{e.filename or 'standard output'}: {e.strerror}")
    if e.filename is None:  # the interpreter flushes once more
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return FAILED


def run(program: str, main: Callable[[Sequence[str]], int], arguments: Optional[Sequence[str]] = None) -> int:
    """Returns the program's exit code: main's, or that of the failure which it has printed as one line."""
    _keep_streams()
    _catch_signals()
    try:
        code = main(sys.argv[1:] if arguments is None else arguments)
    except SystemExit as e:
        code = e.code if isinstance(e.code, int) else FAILED
    except Refusal as e:
        say(program, str(e))
        code = e.code
    except KeyboardInterrupt:
        say(program, "stopped")
        code = FAILED
    except MemoryError:
        say(program, "no memory")
        code = FAILED
    except OSError as e:
        code = _unwritable(program, e)
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError as e:
        code = _unwritable(program, e)
    return code
