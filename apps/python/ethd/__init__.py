"""libethd for trials, study and evaluation: recordings, controllers, scenes and laws, as numpy arrays.

    import ethd
    r = ethd.read("recording")              # a folder that a program recorded
    r.tick["tau"]                           # (n, 2) Nm; r.tick.dtype names every field
    c = r.controller()
    for row in r.tick: c.step(row).tau      # equal to the bit, until an event of the recording

SI units and radians, frame R_0: x right, y up. Nothing here is realtime.
"""
import os as _os
import sys as _sys

# Plug-ins call the library by its public names.
_before = _sys.getdlopenflags()
_sys.setdlopenflags(_before | _os.RTLD_GLOBAL)
try:
    from ethd import _native
finally:
    _sys.setdlopenflags(_before)

from ethd.controller import Controller, Event, Step
from ethd.errors import Busy, Error
from ethd.law import Law, Param, contact_law, laws, tracking_law, transition_law
from ethd.recording import Recording, read
from ethd.scene import Nearest, Scene

__version__: str = _native.ffi.string(_native.lib.ETHD_VERSION).decode()
__all__ = [
    "Busy", "Controller", "Error", "Event", "Law", "Nearest", "Param", "Recording", "Scene", "Step",
    "contact_law", "laws", "read", "tracking_law", "transition_law",
]
