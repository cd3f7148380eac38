"""A controller: one call a tick, the very code that a device's loop runs."""
import os
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from ethd._native import ffi, lib
from ethd.errors import Error, check, check_error, text
from ethd.law import Law, listed

Path = Union[str, "os.PathLike[str]"]


def _row(size: int) -> Any:
    """The dtype of the first `size` bytes of a trace, by the library's own table of columns."""
    fields: Any = {"names": [], "formats": [], "offsets": [], "itemsize": size}
    i = 0
    while lib.ethd_trace_columns[i].name != ffi.NULL and lib.ethd_trace_columns[i].offset < size:
        c = lib.ethd_trace_columns[i]
        kind = "<f8" if c.type == b"f" else "<i8"
        fields["names"].append(ffi.string(c.name).decode())
        fields["formats"].append(kind if c.count == 1 else (kind, (c.count,)))
        fields["offsets"].append(c.offset)
        i += 1
    return np.dtype(fields)


def _units() -> Dict[str, str]:
    found, i = {}, 0
    while lib.ethd_trace_columns[i].name != ffi.NULL:
        c = lib.ethd_trace_columns[i]
        found[ffi.string(c.name).decode()] = ffi.string(c.unit).decode()
        i += 1
    return found


#: A row of tick.npy: what was sensed, then what the tick worked out. include/ethd/sense.h says what each field means.
TRACE: "np.dtype[np.void]" = _row(ffi.sizeof("ethd_trace"))
#: A row that only says what is sensed.
SENSE: "np.dtype[np.void]" = _row(ffi.sizeof("ethd_sense"))
#: The unit of each field of a row ("rad", "m/s", ..), "1" of a number without one.
UNITS: Dict[str, str] = _units()


def _sensed(row: Any) -> bytes:
    """What `row` senses, as the library's bytes; of other fields than its own a row isn't taken."""
    if not isinstance(row, (np.void, np.ndarray)) or row.dtype.names is None:
        raise TypeError(f"found {type(row).__name__}; a row of a recording's tick, or one of ethd.SENSE, is allowed")
    if row.shape:
        raise ValueError(f"found an array of the shape {row.shape}; a tick takes one row, as array[0] is one")
    if row.dtype in (TRACE, SENSE):
        return row.tobytes()
    sense = np.zeros((), SENSE)
    for name in SENSE.names or ():
        if name not in row.dtype.names:
            raise ValueError(f"{name}: missing in the row; all fields of ethd.SENSE are needed")
        if row.dtype[name] != SENSE[name]:
            raise ValueError(f"{name}: found {row.dtype[name]}, {SENSE[name]} is allowed, as in ethd.SENSE")
        sense[name] = row[name]
    return sense.tobytes()


class Step(NamedTuple):
    """The result of a tick."""

    tau: NDArray[np.float64]  #: Nm, joints 1 and 2
    trace: np.void  #: a row as in tick.npy
    status: int  #: 0, or the library's negative number: then the torque is the safe one
    safe: bool  #: the device may let go


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


class Controller:
    """A controller for a configuration: a file's path, the text itself (of several lines), or None for all defaults.

    Relative paths in a file start at its folder, in a text at the working directory. None of this is realtime. With
    plugins=False a configuration that names plug-ins is refused, now or in post(), and none is opened: in somebody else's
    folder they are somebody else's programs.
    """

    def __init__(self, config: Optional[Path] = None, plugins: bool = True):
        self._plugins = plugins
        self._config = Config(config, plugins)
        self._setup = ffi.new("ethd_setup *", self._config.c.setup)
        self._command = ffi.new("ethd_command *")
        self._kept: List[Any] = [self._config]  # configurations whose scenes may still be used
        self._laws: List[Law] = []
        self._create()

    def _create(self) -> None:
        made, error = ffi.new("ethd_control **"), ffi.new("ethd_error *")
        check_error(lib.ethd_control_create(self._setup, made, error), error)
        self._control = ffi.gc(made[0], lib.ethd_control_destroy)

    def step(self, row: Union[np.void, NDArray[Any]]) -> Step:
        """One tick of what `row` senses: a row of a recording's tick, or one of ethd.SENSE, or of any dtype that has SENSE's
        fields, each of the same type. rad, rad/s, m and m/s in R_0, ns; UNITS has the unit of each."""
        data = _sensed(row)
        trace: Any = np.zeros((), TRACE)
        status = lib.python_step(self._control, data, self._command, ffi.from_buffer("char[]", trace))
        tau = np.array((self._command.torque[0], self._command.torque[1]))
        return Step(tau, trace[()], int(status), bool(self._command.safe))

    def post(self, config: Union[None, Path, Mapping[str, Any]]) -> None:
        """Sets what rules from the next step on: another configuration, or changes of the present one by "section.key".

            c.post({"transition.law": "smooth", "contact.k_e": 500})
            c.post({"transition.law": mine})            # made by ethd.transition_law

        The torque doesn't jump: the difference fades over `transition.swap_time`. Busy: the last post has not been taken
        yet. On any error everything stays as it was.
        """
        setup = ffi.new("ethd_setup *", self._setup[0])
        read = self._config
        if isinstance(config, Mapping):
            for key, value in config.items():
                self._change(setup, key, value)
        else:
            read = Config(config, self._plugins)
            setup[0] = read.c.setup
        self._post(setup)
        self._config = read
        if read not in self._kept:
            self._kept.append(read)

    def _post(self, setup: Any) -> None:
        error = ffi.new("ethd_error *")
        check_error(lib.ethd_control_post(self._control, setup, error), error)
        self._setup = setup

    def _change(self, setup: Any, key: str, value: Any) -> None:
        message = text()
        if isinstance(value, Law):
            if key != value.kind + ".law":
                raise Error(lib.ETHD_E_ARGUMENT, f"{key}: {value.id} is a {value.kind} law, of {value.kind}.law")
            getattr(lib, "ethd_setup_" + value.kind)(setup, value._struct[0])
            self._laws.append(value)
        elif key in ("tracking.law", "contact.law", "transition.law"):
            kind = key.split(".")[0]
            known = [law.id for law in self._laws_known() if law.kind == kind]
            if kind != "transition" and value not in known:
                raise Error(lib.ETHD_E_UNKNOWN, f"{key}: found {value!r}, {', '.join(known)} are allowed")
            check(lib.ethd_config_law(self._config.c, kind.encode(), str(value).encode(), setup, message), message)
        else:
            words = value if isinstance(value, str) else repr(float(value))
            check(lib.ethd_config_set(self._config.c, key.encode(), words.encode(), setup, message), message)

    def _rule(self, setup: Any, law: Law) -> None:
        """Puts a law in the place of the one of its kind; numbers that both have keep their values."""
        keys = [f"{law.kind}.{p.name}".encode() for p in law.params]
        values = [lib.ethd_setup_get(setup, key) for key in keys]
        self._change(setup, law.kind + ".law", law)
        error = ffi.new("ethd_error *")
        for key, value in zip(keys, values):
            if value == value:
                check_error(lib.ethd_setup_set(setup, key, value, error), error)

    def _laws_known(self) -> List[Law]:
        """The library's laws and those of the configuration's plugins."""
        return listed(self._config.c.laws)

    def events(self) -> List[Event]:
        """What has happened since the last call, in order."""
        kinds = {lib.ETHD_EVENT_FAULT: "fault", lib.ETHD_EVENT_TAKEN: "taken", lib.ETHD_EVENT_CLEARED: "cleared",
                 lib.ETHD_EVENT_RELEASED: "released"}
        found: List[Event] = []
        event = ffi.new("ethd_event *")
        while lib.ethd_control_poll(self._control, event) == lib.ETHD_OK:
            fault = event.kind == lib.ETHD_EVENT_FAULT
            sentence = ffi.string(lib.ethd_fault_sentence(event.code)).decode() if fault else ""
            found.append(Event(kinds[event.kind], sentence, event.tick, event.value))
            if event.scene != ffi.NULL:
                self._kept = [c for c in self._kept if c is self._config or c.c.scene != event.scene]
        return found

    def clear(self) -> None:
        """Acknowledges a latched fault: the next step begins softly, once limits.clean_time is over."""
        lib.ethd_control_acknowledge(self._control)

    def reset(self) -> None:
        """Forgets everything except the setup that rules."""
        lib.ethd_control_reset(self._control)
