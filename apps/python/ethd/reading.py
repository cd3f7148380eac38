"""What a folder holds: a recording or a study."""
import os
from typing import Any, Union

from ethd_programs.files import there
from ethd.recording import Recording, SpaceRecording, ini
from ethd.study import Study


def read(folder: Union[str, "os.PathLike[str]"], plugins: bool = False) -> Union[Recording, Any]:
    """A Recording, or of space a SpaceRecording, where the folder holds tick.npy, or the Study that ethd-study wrote there.

    Reading runs nothing, follows no link in the folder, and reads only regular files there. With plugins=True the plug-ins
    that a recording names are loaded for its controllers: they are programs that run with your rights. To a checker of types the result is a Recording; `ethd.Study(folder)` is typed too.
    """
    path = os.fsdecode(folder)
    if there(path, "tick.npy"):
        is_space = ini(os.path.join(path, "config.ini")).has_section("space")
        return (SpaceRecording if is_space else Recording)(path, plugins)
    if there(path, "study.ini"):
        return Study(path, plugins)
    raise FileNotFoundError(f"{path}: no recording there, which has a tick.npy, and no study, which has a study.ini")
