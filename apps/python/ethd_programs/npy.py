"""NumPy's files of arrays that somebody else may have made."""
import math
import os
from typing import Any, BinaryIO, NamedTuple, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd_programs.files import has_hole, opened


class Header(NamedTuple):
    shape: Tuple[int, ...]
    fortran: bool
    dtype: "np.dtype[Any]"
    data: int  #: where the rows begin, in bytes


def header(file: BinaryIO) -> Header:
    """What the file says of its array. ValueError: it is none, holds objects, or rows of it were never written."""
    read: Any = np.lib.format
    version = read.read_magic(file)
    if version != (1, 0):
        raise ValueError(f"found the version {version}, (1, 0) is allowed")
    shape, fortran, dtype = read.read_array_header_1_0(file)
    if dtype.hasobject:
        raise ValueError("objects aren't numbers")
    if has_hole(file, file.tell() + math.prod(shape) * dtype.itemsize):
        raise ValueError("it has a hole: some of its rows were never written")
    return Header(shape, fortran, dtype, file.tell())


def mapped(folder: str, *names: str) -> NDArray[Any]:
    """The array in folder/names..., mapped from its file, so that it takes no memory before it is looked at."""
    with opened(folder, *names) as file:
        try:
            h = header(file)
            found: NDArray[Any] = np.memmap(file, h.dtype, "r", h.data, h.shape, "F" if h.fortran else "C")
        except (ValueError, EOFError, OverflowError) as e:
            raise ValueError(f"{os.path.join(folder, *names)}: no array, or cut short: {e}") from None
    return found
