"""NumPy's files of arrays that somebody else may have made."""
import math
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ethd_programs.files import has_hole, opened


def array_in(folder: str, *names: str, whole: bool = False) -> NDArray[Any]:
    """The array in folder/names..., mapped from its file, so that it takes no memory before it is looked at; whole: in memory, so
    that a file that is cut short meanwhile can't end the program. ValueError: there is none, it holds objects, or rows of it were
    never written."""
    read: Any = np.lib.format
    with opened(folder, *names) as file:
        try:
            version = read.read_magic(file)
            if version != (1, 0):
                raise ValueError(f"found the version {version}, (1, 0) is allowed")
            shape, fortran, dtype = read.read_array_header_1_0(file)
            if dtype.hasobject:
                raise ValueError("objects aren't numbers")
            if has_hole(file, file.tell() + math.prod(shape) * dtype.itemsize):
                raise ValueError("it has a hole: some of its rows were never written")
            if whole:
                return np.frombuffer(file.read(math.prod(shape) * dtype.itemsize), dtype).reshape(shape, order="F" if fortran else "C")
            found: NDArray[Any] = np.memmap(file, dtype, "r", file.tell(), shape, "F" if fortran else "C")
        except (ValueError, EOFError, OverflowError) as e:
            raise ValueError(f"{os.path.join(folder, *names)}: no array, or cut short: {e}") from None
    return found
