"""A controller: one call a tick, the very code that a device's loop runs."""
import os
from typing import Any, List, Mapping, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from ethd._native import ffi, lib
from ethd.errors import Error, check, check_error, text
from ethd.law import Law, laws

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


_SENSE_BYTES: int = ffi.sizeof("ethd_sense")
#: A row of tick.npy: what was sensed, then what the tick worked out.
TRACE: Any = _row(ffi.sizeof("ethd_trace"))
#: A row that only says what is sensed.
SENSE: Any = _row(_SENSE_BYTES)


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
            status = lib.ethd_config_parse(data, len(data), b"configuration", os.getcwd().encode(), made, message)
        else:
            load = lib.ethd_config_load if plugins else lib.ethd_config_load_received
            status = load(os.fsencode(path) if path is not None else ffi.NULL, made, message)
        check(status, message)
        self.c = ffi.gc(made[0], lib.ethd_config_free)


class Controller:
    """A controller for a configuration: a file's path, the text itself (of several lines), or None for all defaults.

    Relative paths in a file start at its folder. None of this is realtime. With plugins=False a configuration that names
    plug-ins is refused, since in somebody else's folder they are somebody else's programs.
    """

    def __init__(self, config: Optional[Path] = None, plugins: bool = True):
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
        """One tick of what `row` senses: a row of a recording's tick, or one of ethd.controller.SENSE."""
        trace: Any = np.zeros((), TRACE)
        data = row.tobytes() if isinstance(row, (np.void, np.ndarray)) else bytes(row)
        if len(data) < _SENSE_BYTES:
            raise ValueError(f"a row has {len(data)} bytes; at least the {_SENSE_BYTES} of ethd.controller.SENSE are needed")
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
            read = Config(config)
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
        elif key in ("tracking.law", "contact.law"):
            kind = key.split(".")[0]
            known = {law.id: law for law in laws() if law.kind == kind}
            if value not in known:
                raise Error(lib.ETHD_E_UNKNOWN, f"{key}: found {value!r}, {', '.join(known)} are allowed")
            self._change(setup, key, known[value])
        elif key == "transition.law":
            check(lib.ethd_config_transition(self._config.c, str(value).encode(), setup, message), message)
        else:
            words = value if isinstance(value, str) else repr(float(value))
            check(lib.ethd_config_set(self._config.c, key.encode(), words.encode(), setup, message), message)

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
        lib.ethd_control_clear(self._control)

    def reset(self) -> None:
        """Forgets everything except the setup that rules."""
        lib.ethd_control_reset(self._control)
