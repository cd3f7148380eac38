"""libethd for trials, study and evaluation: recordings, controllers, scenes and laws, as numpy arrays.

    import ethd
    r = ethd.read("recording")              # a folder that a program recorded
    r.tick["tau"]                           # (n, 2) Nm; r.tick.dtype names every field
    for row, step in r.replay(): step.tau   # run again, events too: equal to row["tau"], to the bit
    c = r.controller()                      # one as the recording began; c.step(row) as you like
    s = ethd.read("study")                  # a folder of ethd-study: s.taps, s.participants, s.trials()

    s = ethd.Space("room.ini")              # a controller in space; s.step(sense, s.surfaces(x, 0.5))

SI units and radians, frame R_0: x right, y up; in space the user's choice. Nothing here is realtime.
"""
import os as _os
import sys as _sys

# Plug-ins call the library by its public names.
_before = _sys.getdlopenflags()
_sys.setdlopenflags(_before | _os.RTLD_GLOBAL)
try:
    from ethd import _native
except ImportError as error:
    raise ImportError(f"ethd isn't built here ({error}); pip install ./apps/python, and run outside of apps/python") from error
finally:
    _sys.setdlopenflags(_before)

from ethd.controller import SENSE, SPACE_SENSE, SPACE_TRACE, SPACE_UNITS, SURFACE, TRACE, UNITS, Controller, Event, Space, SpaceStep, Step
from ethd.errors import Busy, Error
from ethd.law import Law, Param, State, contact_law, laws, tracking_law, transition_law
from ethd.reading import read
from ethd.recording import Recording, SpaceRecording
from ethd.scene import Nearest, Scene
from ethd.study import Study
from ethd_programs.recording import RecordedEvent

__version__: str = _native.ffi.string(_native.lib.ETHD_VERSION).decode()
__all__ = [
    "SENSE", "SPACE_SENSE", "SPACE_TRACE", "SPACE_UNITS", "SURFACE", "TRACE", "UNITS", "Busy", "Controller", "Error", "Event",
    "Law", "Nearest", "Param", "RecordedEvent", "Recording", "Scene", "Space", "SpaceRecording", "SpaceStep", "State", "Step", "Study", "contact_law", "laws", "read", "tracking_law", "transition_law",
]
