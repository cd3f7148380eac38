"""Scenes: the signed distance to objects of the plane."""
import os
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ethd._native import ffi, lib
from ethd.errors import check_error


class Nearest(NamedTuple):
    """The nearest object to each point."""

    distance: NDArray[np.float64]  #: m, < 0 inside
    normal: NDArray[np.float64]  #: (..., 2), unit vectors into the object
    object: NDArray[np.int32]  #: its number; -1 in an empty scene


class Scene:
    """A scene from text ("circle 0 0 0.1"), from a file's path, or from an open file.

    A string that names an existing file is that file; any other is the scene itself.
    """

    def __init__(self, source: Union[str, "os.PathLike[str]", Any]):
        name: Any = "scene"
        words: Any = source
        if hasattr(source, "read"):
            name, words = getattr(source, "name", name), source.read()
        elif isinstance(source, os.PathLike) or ("\n" not in source and os.path.exists(source)):
            name = os.fspath(source)
            with open(name, encoding="utf-8") as file:
                words = file.read()
        elif len(source.split()) == 1:  # no scene has one word
            raise FileNotFoundError(f"{source}: No such file")
        data = words.encode() if isinstance(words, str) else bytes(words)
        made, error = ffi.new("ethd_scene **"), ffi.new("ethd_error *")
        check_error(lib.ethd_scene_parse(data, len(data), made, error), error, str(name))
        self._scene = ffi.gc(made[0], lib.ethd_scene_destroy)

    def nearest(self, points: ArrayLike) -> Nearest:
        """Distance, normal and object for points of shape (..., 2) in m, R_0; the results have the shape before the 2. A point
        that isn't finite has neither distance nor normal (NaN), and no object (-1)."""
        at = np.ascontiguousarray(points, dtype=np.float64)
        if not at.ndim or at.shape[-1] != 2:
            raise ValueError(f"points have the shape {at.shape}; (..., 2) is allowed")
        shape = at.shape[:-1]
        distance, normal, number = np.empty(shape), np.empty(at.shape), np.empty(shape, np.int32)
        lib.python_nearest(
            self._scene, distance.size, ffi.from_buffer("double[]", at), ffi.from_buffer("double[]", distance),
            ffi.from_buffer("double[]", normal), ffi.from_buffer("int32_t[]", number))
        nowhere = ~np.isfinite(at).all(axis=-1)
        distance[nowhere], normal[nowhere], number[nowhere] = np.nan, np.nan, -1
        return Nearest(distance, normal, number)
