"""Laws: what the library offers, and laws written in Python for trials on the desk. Those are not realtime."""
from contextlib import contextmanager
from dataclasses import dataclass
from enum import IntEnum
from types import SimpleNamespace
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd._native import ffi, lib
from ethd.errors import check_error

KINDS = ("tracking", "contact", "transition")


class State(IntEnum):
    """The paper's states of a contact, for `out.state` of a transition law. A law may number its own from 3 up."""

    TRANSPARENT = lib.ETHD_TRANSPARENT
    BRAKING = lib.ETHD_BRAKING
    VO = lib.ETHD_VO


@dataclass(frozen=True)
class Param:
    """One number of a law: name, unit (or the words of a choice joined by '|'), range, default, description."""

    name: str
    unit: str
    min: float
    max: float
    default: float
    brief: str


@dataclass(frozen=True)
class Law:
    """A law that the library offers or that was made here."""

    kind: str  #: tracking, contact or transition
    id: str
    brief: str
    params: Tuple[Param, ...]
    _struct: Any = None  #: the library's, with all that a law made here keeps alive


def _word(text: Any) -> str:
    return str(ffi.string(text).decode())


def describe(law: Any) -> Law:
    rows = (law.params[i] for i in range(law.param_count))
    params = tuple(Param(_word(p.name), _word(p.unit), p.min, p.max, getattr(p, "def"), _word(p.brief)) for p in rows)
    kind = KINDS[law.kind]
    return Law(kind, _word(law.id), _word(law.brief), params, (ffi.cast(f"const ethd_{kind}_law *", law), None))


def listed(table: Any) -> List[Law]:
    """The laws of a table that ends with NULL."""
    found, i = [], 0
    while table[i] != ffi.NULL:
        found.append(describe(table[i]))
        i += 1
    return found


def laws() -> List[Law]:
    """All laws that are built in, with their parameters."""
    return listed(lib.ethd_laws)


def _made(kind: str, id: str, step: Callable[..., Any], brief: str, params: Dict[str, Any], numbers: int) -> Law:
    """The library's struct for a law whose C entry is `step`."""
    rows = [Param(name, *_row(name, value)) for name, value in params.items()]
    alive: List[Any] = []

    def words(text: str) -> Any:
        alive.append(ffi.new("char[]", text.encode()))
        return alive[-1]

    table = ffi.new("ethd_param[]", max(len(rows), 1))
    for at, row in zip(table, rows):
        at.name, at.unit, at.brief = words(row.name), words(row.unit), words(row.brief)
        at.min, at.max = row.min, row.max
        setattr(at, "def", row.default)
    struct = ffi.new(f"ethd_{kind}_law *")
    struct.law.size, struct.law.abi, struct.law.kind = ffi.sizeof(struct[0]), lib.ethd_laws[0].abi, KINDS.index(kind)
    struct.law.state_size = 8 * numbers
    struct.law.id, struct.law.brief = words(id), words(brief)
    struct.law.params, struct.law.param_count = table, len(rows)
    struct.step = step
    alive += [table, step, struct]
    error = ffi.new("ethd_error *")
    check_error(lib.ethd_law_check(ffi.addressof(struct.law), error), error, id)
    return Law(kind, id, brief, tuple(rows), (struct, alive))


def _row(name: str, value: Any) -> Tuple[str, float, float, float, str]:
    try:
        default, least, most, unit = value if isinstance(value, tuple) else (value, -1e9, 1e9, "1")
        return str(unit), float(least), float(most), float(default), "of a law in Python"
    except (TypeError, ValueError):
        raise ValueError(f"{name}: found {value!r}; a number, or (default, least, most, unit), is allowed") from None


# A law is shown copies, which it may keep: the library's own memory is another contact's after the call, or gone.


def _copied(of: Any) -> Any:
    """A copy: of a struct by its fields' names, of an array as a tuple. A pointer is None: no law in Python looks ahead."""
    kind = ffi.typeof(of) if isinstance(of, ffi.CData) else None
    if kind is None:
        return of
    if kind.kind == "array":
        return tuple(of)
    if kind.kind == "pointer" and (kind.item.kind != "struct" or not of):
        return None
    fields = (kind.item if kind.kind == "pointer" else kind).fields
    return SimpleNamespace(**{name: _copied(getattr(of, name)) for name, _ in fields})


@contextmanager
def _state(block: Any, numbers: int) -> Iterator[Optional[NDArray[np.float64]]]:
    """The law's state as an array of its own, which goes back into the block when the call ends."""
    if not numbers:
        yield None
        return
    there = np.frombuffer(ffi.buffer(ffi.cast("double *", block), 8 * numbers), dtype=np.float64)
    own = there.copy()
    try:
        yield own
    finally:
        there[:] = own


#: What the C entry of each kind takes beside parameters and state; the last one is its result.
_TAKES = {"transition": "const ethd_contact *, ethd_ruling *", "contact": "double, double, int, double *",
          "tracking": "const ethd_tracking_in *, double *"}


def _decorator(kind: str, id: str, brief: str, state: int, params: Dict[str, Any]) -> Callable[[Callable[..., Any]], Law]:
    def make(function: Callable[..., Any]) -> Law:
        def step(p: Any, block: Any, *taken: Any) -> int:
            out, given = taken[-1], [_copied(of) for of in taken[:-1]]
            if kind == "transition":
                given.append(ffi.new("ethd_ruling *", out[0]))
            elif kind == "contact":
                given[2] = bool(given[2])
            with _state(block, state) as own:
                found = function({name: p[i] for i, name in enumerate(params)}, own, *given)
            if kind == "tracking":
                out[0], out[1] = found
            else:
                out[0] = found if kind == "contact" else given[-1][0]
            return 0

        # an exception in it sends the controller to its safe state
        entry = ffi.callback(f"ethd_status(*)(const double *, void *, {_TAKES[kind]})", step, error=lib.ETHD_E_LAW)
        return _made(kind, id, entry, brief, params, state)

    return make


def transition_law(id: str, brief: str = "a law in Python", state: int = 0, **params: Any) -> Callable[[Callable[..., None]], Law]:
    """A decorator: who rules at a contact. The function gets (p, state, contact, out): the parameters by name, `state`
    numbers that the controller keeps for each contact (None for 0), an ethd_contact to read and an ethd_ruling to fill
    (beta, share, offset m, damping Ns/m, state); include/ethd/law.h says what they mean. All are the call's own: what a law
    keeps of them stays as it was, and what it writes into them later changes nothing.

        @ethd.transition_law("mine", brake=(60, 0, 1000, "Ns/m"))
        def mine(p, state, contact, out):
            out.damping = p["brake"] if contact.d_re < 0 else 0
    """
    return _decorator("transition", id, brief, state, params)


def contact_law(id: str, brief: str = "a law in Python", state: int = 0, **params: Any) -> Callable[[Callable[..., float]], Law]:
    """A decorator: a wall's force. The function gets (p, state, gap, speed, entering): m to the wall (< 0 inside), m/s (> 0
    entering), and returns N along the normal, <= 0: the wall pushes the ring out."""
    return _decorator("contact", id, brief, state, params)


def tracking_law(id: str, brief: str = "a law in Python", state: int = 0, **params: Any) -> Callable[[Callable[..., Any]], Law]:
    """A decorator: how the ring follows the finger. The function gets (p, state, motion), an ethd_tracking_in, and returns the
    two joint torques in Nm."""
    return _decorator("tracking", id, brief, state, params)
