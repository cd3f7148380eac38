"""Tables: CSV files of the programs as structured arrays. An empty cell is a number that isn't defined, or wasn't asked."""
import csv
import io
import os
import re
from typing import Any, Iterator, List, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd_programs.cli import plural
from ethd_programs.files import has_hole, opened

#: A column whose name ends in a unit is float64, even if it is empty or holds only integers.
_UNITS = re.compile(r".*_(m|mm|s|ms|mps|rad|radps|n|N|nm|Nm|hz)")
#: Columns of whole numbers, which are numbers even where none is given.
_COUNTS = {"analysed", "attempt", "block", "point", "seed", "tap", "taps", "valid"}
_INTEGER = re.compile(r"-?[0-9]+")
_NUMBER = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?|[-+]?(nan|inf)")


def _column(name: str, cells: List[str]) -> NDArray[Any]:
    """int64 if each cell is an integer; float64, NaN where a cell is empty, if they are numbers; else text."""
    given = [cell for cell in cells if cell]
    has_unit = _UNITS.fullmatch(name) is not None
    numbers = all(_NUMBER.fullmatch(cell) for cell in given) and (bool(given) or has_unit or name in _COUNTS)
    integers = numbers and bool(given) and not has_unit and all(_INTEGER.fullmatch(cell) for cell in given)
    if integers and len(given) == len(cells) and all(-(2**63) <= int(cell) < 2**63 for cell in cells):
        return np.array([int(cell) for cell in cells], np.int64)
    # an integer that a float64 can't hold would become another one
    if numbers and not (integers and any(int(float(cell)) != int(cell) for cell in given)):
        return np.array([float(cell) if cell else np.nan for cell in cells], np.float64)
    return np.array(cells, np.str_) if cells else np.array([], "U1")


MOST = 1 << 32  #: bytes of a file of text


def words(path: str, errors: str = "strict") -> str:
    """A file's text; `errors` as in bytes.decode."""
    with opened(*os.path.split(path)) as file:
        size = os.fstat(file.fileno()).st_size
        if size > MOST:
            raise ValueError(f"{path}: {size} bytes, at most {MOST} are allowed")
        if has_hole(file, size):
            raise ValueError(f"{path}: has a hole, so it isn't text")
        data = file.read()
    try:
        return data.decode("utf-8", errors)
    except UnicodeDecodeError as e:
        line = data.count(b"\n", 0, e.start) + 1
        raise ValueError(f"{path}:{line}: found the byte {data[e.start]:#x}, UTF-8 is allowed") from None


def rows(path: str, text: str) -> Iterator[Tuple[int, List[str]]]:
    """The cells of each line of a CSV file, with the line's number."""
    if "\0" in text:
        raise ValueError(f"{path}: a byte 0: this isn't text")
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        for row in reader:
            yield reader.line_num, row
    except csv.Error as e:
        why = "a quote that isn't closed" if "unexpected end" in str(e) else e
        raise ValueError(f"{path}:{reader.line_num}: {why}") from None


def lines(path: str, errors: str = "strict") -> Iterator[Tuple[int, List[str]]]:
    return rows(path, words(path, errors))


def named(path: str, text: str) -> Iterator[List[str]]:
    """The names of a table's columns, then the cells of each row."""
    found = rows(path, text)
    _, names = next(found, (1, []))
    if not names or "" in names or len(set(names)) != len(names):
        raise ValueError(f"{path}:1: a name for each column is needed, and each once")
    yield names
    for number, row in found:
        if len(row) != len(names):
            raise ValueError(f"{path}:{number}: found {len(row)} cell{plural(len(row))}, {len(names)} are allowed")
        yield row


def table(path: str) -> NDArray[Any]:
    """A row for each line after the first, which names the columns."""
    names, *cells = named(path, words(path))
    columns = [_column(name, [row[i] for row in cells]) for i, name in enumerate(names)]
    found: Any = np.empty(len(cells), [(name, column.dtype) for name, column in zip(names, columns)])
    for name, column in zip(names, columns):
        found[name] = column
    return found  # type: ignore[no-any-return]
