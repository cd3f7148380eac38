"""A controller: one call a tick, the very code that a device's loop runs."""
import os
from typing import Any, Dict, FrozenSet, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ethd._native import ffi, lib
from ethd.errors import Error, check, check_error, text
from ethd.law import Law, listed

Path = Union[str, "os.PathLike[str]"]


def _columns(table: Any) -> Iterator[Any]:
    """A table of columns of the library, column by column."""
    i = 0
    while table[i].name != ffi.NULL:
        yield table[i]
        i += 1


def _row(table: Any, size: int) -> Any:
    """The dtype of the first `size` bytes of a trace, by the library's own table of columns."""
    fields: Any = {"names": [], "formats": [], "offsets": [], "itemsize": size}
    for c in _columns(table):
        if c.offset < size:
            kind = "<f8" if c.type == b"f" else "<i8"
            fields["names"].append(ffi.string(c.name).decode())
            fields["formats"].append(kind if c.count == 1 else (kind, (c.count,)))
            fields["offsets"].append(c.offset)
    return np.dtype(fields)


def _units(table: Any) -> Dict[str, str]:
    return {ffi.string(c.name).decode(): ffi.string(c.unit).decode() for c in _columns(table)}


#: A row of tick.npy: what was sensed, then what the tick worked out. include/ethd/sense.h says what each field means.
TRACE: "np.dtype[np.void]" = _row(lib.ethd_trace_columns, ffi.sizeof("ethd_trace"))
#: A row that only says what is sensed.
SENSE: "np.dtype[np.void]" = _row(lib.ethd_trace_columns, ffi.sizeof("ethd_sense"))
#: The unit of each field of a row ("rad", "m/s", ..), "1" of a number without one.
UNITS: Dict[str, str] = _units(lib.ethd_trace_columns)
#: The same of space: include/ethd/space.h says what each field means.
SPACE_TRACE: "np.dtype[np.void]" = _row(lib.ethd_space_trace_columns, ffi.sizeof("ethd_space_trace"))
SPACE_SENSE: "np.dtype[np.void]" = _row(lib.ethd_space_trace_columns, ffi.sizeof("ethd_space_sense"))
SPACE_UNITS: Dict[str, str] = _units(lib.ethd_space_trace_columns)
#: A point at which something is near, as include/ethd/surface.h has it: m, m/s in R_0; n is a unit vector into the object.
SURFACE: "np.dtype[np.void]" = np.dtype([("point", "<f8", (3,)), ("n", "<f8", (3,)), ("v", "<f8", (3,)), ("id", "<i4"), ("material", "<i4")])

#: Fields that a recording of an earlier version may lack, and which are then 0.
NEWER: FrozenSet[str] = frozenset(ffi.string(c.name).decode() for c in _columns(lib.ethd_trace_columns) if c.newer)


def is_row(dtype: "np.dtype[Any]") -> bool:
    """Whether rows of a recording have the fields of TRACE, of this version or an earlier one."""
    expected = [name for name in TRACE.names or () if name in (dtype.names or ()) or name not in NEWER]
    return list(dtype.names or ()) == expected and all(dtype[name] == TRACE[name] for name in expected)


def _sensed(row: Any, trace: "np.dtype[Any]" = TRACE, fields: "np.dtype[Any]" = SENSE, name: str = "ethd.SENSE") -> bytes:
    """What `row` senses, as the library's bytes; of other fields than its own a row isn't taken."""
    if not isinstance(row, (np.void, np.ndarray)) or row.dtype.names is None:
        raise TypeError(f"found {type(row).__name__}; a row of a recording's tick, or one of {name}, is allowed")
    if row.shape:
        raise ValueError(f"found an array of the shape {row.shape}; a tick takes one row, as array[0] is one")
    if row.dtype in (trace, fields):
        return row.tobytes()
    sense = np.zeros((), fields)
    for field in fields.names or ():
        if field not in row.dtype.names and field in NEWER:
            continue
        if field not in row.dtype.names:
            raise ValueError(f"{field}: missing in the row; all fields of {name} are needed")
        if row.dtype[field] != fields[field]:
            raise ValueError(f"{field}: found {row.dtype[field]}, {fields[field]} is allowed, as in {name}")
        sense[field] = row[field]
    return sense.tobytes()


def surfaces_of(row: Any) -> NDArray[Any]:
    """The surfaces that a recorded tick in space looked at, of the dtype SURFACE; one that is impossible where it refused them."""
    if row["near"] == lib.ETHD_NEAR_REFUSED:
        bad: NDArray[Any] = np.zeros(1, SURFACE)
        bad["point"] = np.nan
        return bad
    near: NDArray[Any] = np.zeros(min(max(int(row["near"]), 0), len(row["near_id"])), SURFACE)
    for name, size in (("point", 3), ("n", 3), ("v", 3)):
        near[name] = row["near_" + name][: size * len(near)].reshape(-1, size)
    near["id"], near["material"] = row["near_id"][: len(near)], row["near_material"][: len(near)]
    return near


class Step(NamedTuple):
    """The result of a tick."""

    tau: NDArray[np.float64]  #: Nm, joints 1 and 2
    trace: np.void  #: a row as in tick.npy
    status: int  #: 0, or the library's negative number: then the torque is the safe one
    safe: bool  #: the device may let go


class SpaceStep(NamedTuple):
    """The result of a tick in space."""

    value: NDArray[np.float64]  #: N or m/s, by space.command
    normal: NDArray[np.float64]  #: unit vector that a plate is to face
    trace: np.void  #: a row as in tick.npy
    status: int  #: 0, or the library's negative number
    safe: bool  #: the device is to go into its safe state


class Event(NamedTuple):
    """Something that happened in a tick."""

    kind: str  #: fault, taken, cleared, released
    text: str  #: of a fault its sentence
    tick: int
    value: float


class Config:
    """A configuration that was read; owns its scene."""

    def __init__(self, source: Optional[Path], plugins: bool = True):
        made, message = ffi.new("ethd_config **"), text()
        path = os.fspath(source) if source is not None else None
        if path is not None and "\n" in path:
            data = path.encode()
            parse = lib.ethd_config_parse if plugins else lib.ethd_config_parse_received
            status = parse(data, len(data), b"configuration", os.fsencode(os.getcwd()), made, message)
        else:
            load = lib.ethd_config_load if plugins or path is None else lib.ethd_config_load_received
            status = load(os.fsencode(path) if path is not None else ffi.NULL, made, message)
        check(status, message)
        self.c = ffi.gc(made[0], lib.ethd_config_free)


class _Front:
    """What the controllers of the plane and of space share. A front's functions in the library begin alike."""

    _control_: str  #: "ethd_control_"
    _setup_: str  #: "ethd_setup_"
    _config_: str  #: "ethd_config_"
    _member: str  #: of ethd_config: its setup
    _is_space: bool

    def __init__(self, config: Optional[Path] = None, plugins: bool = True):
        self._plugins = plugins
        self._config = self._read(config)
        self._setup = self._copy(getattr(self._config.c, self._member))
        self._kept: List[Any] = [self._config]  # configurations whose scenes may still be used
        self._laws: List[Law] = []
        self._create()

    def _read(self, source: Optional[Path]) -> Config:
        read = Config(source, self._plugins)
        if bool(read.c.is_space) != self._is_space:
            raise Error(lib.ETHD_E_ARGUMENT, "there is no [space]; ethd.Controller is the plane's" if self._is_space else
                        "[space] is there; ethd.Space is its controller")
        return read

    def _copy(self, setup: Any) -> Any:
        return ffi.new("ethd_space_setup *" if self._is_space else "ethd_setup *", setup)

    def _call(self, name: str, *arguments: Any) -> Any:
        return getattr(lib, self._control_ + name)(*arguments)

    def _create(self) -> None:
        made = ffi.new("ethd_space **" if self._is_space else "ethd_control **")
        error = ffi.new("ethd_error *")
        check_error(self._call("create", self._setup, made, error), error)
        self._control = ffi.gc(made[0], getattr(lib, self._control_ + "destroy"))

    def post(self, config: Union[None, Path, Mapping[str, Any]]) -> None:
        """Sets what rules from the next step on: another configuration, or changes of the present one by "section.key".

            c.post({"transition.law": "smooth", "contact.k_e": 500})
            c.post({"transition.law": mine})            # made by ethd.transition_law

        The torque doesn't jump: the difference fades over `transition.swap_time`. Busy: the last post has not been taken
        yet. On any error everything stays as it was.
        """
        setup = self._copy(self._setup[0])
        read = self._config
        if isinstance(config, Mapping):
            for key, value in config.items():
                self._change(setup, key, value)
        else:
            read = self._read(config)
            setup[0] = getattr(read.c, self._member)
        self._post(setup)
        self._config = read
        if read not in self._kept and not self._is_space:  # a controller in space knows no solids
            self._kept.append(read)

    def _post(self, setup: Any) -> None:
        error = ffi.new("ethd_error *")
        check_error(self._call("post", self._control, setup, error), error)
        self._setup = setup

    def _change(self, setup: Any, key: str, value: Any) -> None:
        message = text()
        if isinstance(value, Law):
            if key != value.kind + ".law":
                raise Error(lib.ETHD_E_ARGUMENT, f"{key}: {value.id} is a {value.kind} law, of {value.kind}.law")
            getattr(lib, self._setup_ + value.kind)(setup, value._struct[0])
            self._laws.append(value)
            self._follow(setup)
        elif key in ("tracking.law", "contact.law", "transition.law"):
            kind = key.split(".")[0]
            known = [law.id for law in self._laws_known() if law.kind == kind]
            if kind != "transition" and value not in known:
                raise Error(lib.ETHD_E_UNKNOWN, f"{key}: found {value!r}, {', '.join(known)} are allowed")
            check(getattr(lib, self._config_ + "law")(self._config.c, kind.encode(), str(value).encode(), setup, message), message)
        else:
            words = value if isinstance(value, str) else repr(float(value))
            check(getattr(lib, self._config_ + "set")(self._config.c, key.encode(), words.encode(), setup, message), message)

    def _rule(self, setup: Any, law: Law) -> None:
        """Puts a law in the place of the one of its kind; numbers that both have keep their values."""
        keys = [f"{law.kind}.{p.name}".encode() for p in law.params]
        values = [getattr(lib, self._setup_ + "get")(setup, key) for key in keys]
        self._change(setup, law.kind + ".law", law)
        error = ffi.new("ethd_error *")
        for key, value in zip(keys, values):
            if value == value:
                check_error(getattr(lib, self._setup_ + "set")(setup, key, value, error), error)
        self._follow(setup)

    def _follow(self, setup: Any) -> None:
        """Lets what follows from a setup's numbers follow from them again."""

    def _laws_known(self) -> List[Law]:
        """The library's laws and those of the configuration's plugins."""
        return listed(self._config.c.laws)

    def events(self) -> List[Event]:
        """What has happened since the last call, in order."""
        kinds = {lib.ETHD_EVENT_FAULT: "fault", lib.ETHD_EVENT_TAKEN: "taken", lib.ETHD_EVENT_CLEARED: "cleared",
                 lib.ETHD_EVENT_RELEASED: "released"}
        found: List[Event] = []
        event = ffi.new("ethd_event *")
        while self._call("poll", self._control, event) == lib.ETHD_OK:
            fault = event.kind == lib.ETHD_EVENT_FAULT
            sentence = ffi.string(lib.ethd_fault_sentence(event.code)).decode() if fault else ""
            found.append(Event(kinds[event.kind], sentence, event.tick, event.value))
            if event.scene != ffi.NULL:
                self._kept = [c for c in self._kept if c is self._config or c.c.scene != event.scene]
        return found

    def clear(self) -> None:
        """Acknowledges a latched fault: the next step begins softly, once limits.clean_time is over."""
        self._call("acknowledge", self._control)

    def reset(self) -> None:
        """Forgets everything except the setup that rules."""
        self._call("reset", self._control)


class Controller(_Front):
    """A controller for a configuration: a file's path, the text itself (of several lines), or None for all defaults.

    Relative paths in a file start at its folder, in a text at the working directory. None of this is realtime. With
    plugins=False a configuration that names plug-ins is refused, now or in post(), and none is opened: in somebody else's
    folder they are somebody else's programs.
    """

    _control_, _setup_, _config_, _member, _is_space = "ethd_control_", "ethd_setup_", "ethd_config_", "setup", False

    def __init__(self, config: Optional[Path] = None, plugins: bool = True):
        super().__init__(config, plugins)
        self._command = ffi.new("ethd_command *")

    def step(self, row: Union[np.void, NDArray[Any]]) -> Step:
        """One tick of what `row` senses: a row of a recording's tick, or one of ethd.SENSE, or of any dtype that has SENSE's
        fields, each of the same type. rad, rad/s, m and m/s in R_0, ns; UNITS has the unit of each."""
        data = _sensed(row)
        trace: Any = np.zeros((), TRACE)
        status = lib.python_step(self._control, data, self._command, ffi.from_buffer("char[]", trace))
        tau = np.array((self._command.torque[0], self._command.torque[1]))
        return Step(tau, trace[()], int(status), bool(self._command.safe))


class Space(_Front):
    """A controller in space, as Controller is one of the plane, for a configuration with a section [space].

        s = ethd.Space("[space]\\nacceleration = 10\\n[scene]\\nfile = room.solids\\n")
        sense = np.zeros((), ethd.SPACE_SENSE)
        sense["have"], sense["x"], sense["finger"] = 1, x, finger
        step = s.step(sense, s.surfaces(x, 0.5))
    """

    _control_, _setup_, _config_, _member, _is_space = "ethd_space_", "ethd_space_", "ethd_config_space_", "space", True

    def __init__(self, config: Path = "[space]\n", plugins: bool = True):
        super().__init__(config, plugins)
        self._command = ffi.new("ethd_space_command *")

    def step(self, row: Union[np.void, NDArray[Any]], surfaces: Union[NDArray[Any], Sequence[Any]] = ()) -> SpaceStep:
        """One tick of what `row` senses, as Controller.step takes one, of ethd.SPACE_SENSE, with the surfaces near it: an array
        of ethd.SURFACE, or tuples of its fields. m, m/s and N in R_0, ns."""
        data = _sensed(row, SPACE_TRACE, SPACE_SENSE, "ethd.SPACE_SENSE")
        near = np.ascontiguousarray(np.array(surfaces, SURFACE) if len(surfaces) else np.zeros(0, SURFACE)).reshape(-1)
        trace: Any = np.zeros((), SPACE_TRACE)
        status = lib.python_space_step(self._control, data, ffi.from_buffer("char[]", near), len(near), self._command,
                                       ffi.from_buffer("char[]", trace))
        value, normal = np.array(list(self._command.value)), np.array(list(self._command.normal))
        return SpaceStep(value, normal, trace[()], int(status), bool(self._command.safe))

    def surfaces(self, x: ArrayLike, distance: float) -> NDArray[Any]:
        """The surfaces of the configuration's solids within `distance`, m, of x, m in R_0, the deepest first; none without solids."""
        solids, at = self._config.c.solids, np.ascontiguousarray(x, dtype=np.float64)
        if at.shape != (3,):
            raise ValueError(f"x has the shape {at.shape}; (3,) is allowed")
        near: NDArray[Any] = np.zeros(lib.ETHD_SURFACES_MAX, SURFACE)
        if solids == ffi.NULL:
            return near[:0]
        found = lib.python_surfaces(solids, ffi.from_buffer("double[]", at), distance, ffi.from_buffer("char[]", near), len(near))
        return near[:found]

    def _follow(self, setup: Any) -> None:
        # any key that is set works out the parameters on the solids' materials anew
        super()._change(setup, "space.period", float(setup.period))
