"""Files, as drivers/runtime/text/file.h and text.h treat them. Below a folder that somebody else may have made no link is followed,
and only regular files are read; only a regular file is ever replaced, and by a whole one."""
import contextlib
import errno
import fcntl
import os
import re
import stat
import time
from types import TracebackType
from typing import BinaryIO, Optional, Type

from ethd_programs.cli import FAILED, Refusal

# ---- reading ----


def _is_link(name: str, folder: int) -> bool:
    try:
        return stat.S_ISLNK(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode)
    except OSError:
        return False


def _open(folder: str, *names: str) -> int:
    """A descriptor of folder/names..., where each name is a single component. The folder itself may be reached through links."""
    at = os.open(folder or ".", os.O_RDONLY | os.O_DIRECTORY)
    for i, name in enumerate(names):
        kind = os.O_NONBLOCK if i + 1 == len(names) else os.O_DIRECTORY
        try:
            inner = os.open(name, os.O_RDONLY | os.O_NOFOLLOW | kind, dir_fd=at)
        except OSError as e:
            path = os.path.join(folder, *names[: i + 1])
            if _is_link(name, at):
                raise ValueError(f"{path}: is a link, which isn't followed in a folder of somebody else; a file is needed") from None
            raise type(e)(e.errno, e.strerror, path) from None
        finally:
            os.close(at)
        at = inner
    return at


def there(folder: str, *names: str) -> bool:
    """Whether the folder holds that file or folder; ValueError: a link is in the way."""
    try:
        os.close(_open(folder, *names))
    except (FileNotFoundError, NotADirectoryError):
        return False
    return True


def opened(folder: str, *names: str) -> BinaryIO:
    """A regular file of the folder, which the caller closes."""
    descriptor = _open(folder, *names)
    mode = os.fstat(descriptor).st_mode
    if not stat.S_ISREG(mode):
        os.close(descriptor)
        kind = "pipe" if stat.S_ISFIFO(mode) else "folder" if stat.S_ISDIR(mode) else "device"
        raise ValueError(f"{os.path.join(folder, *names)}: is a {kind}, a file is needed")
    return open(descriptor, "rb")


def plain_file(path: str, most: int) -> bytes:
    """What a file that the user names holds: a regular one of at most `most` bytes, or a pipe."""
    if not path:
        raise Refusal('"": a file\'s name is needed')
    try:
        with open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NOCTTY)) as file:
            mode = os.fstat(file.fileno()).st_mode
            if stat.S_ISCHR(mode) or stat.S_ISBLK(mode):
                raise Refusal(f"{path}: is a device, a file is needed")
            data = file.read(most + 1)
    except IsADirectoryError:
        raise Refusal(f"{path}: is a folder, a file is needed") from None
    except OSError as e:
        raise Refusal(f"{path}: {reason(e)}") from None
    if len(data) > most:
        raise Refusal(f"{path}: over {most} bytes, at most that many are allowed")
    return data


def has_hole(file: BinaryIO, end: int) -> bool:
    """Whether the file's first `end` bytes have a part that was never written and takes no room on the disk."""
    descriptor = file.fileno()
    at, size = os.lseek(descriptor, 0, os.SEEK_CUR), os.fstat(descriptor).st_size
    hole = os.lseek(descriptor, 0, os.SEEK_HOLE) if size else 0
    os.lseek(descriptor, at, os.SEEK_SET)
    return hole < min(end, size)


def reason(e: OSError) -> str:
    return e.strerror or str(e)


# ---- writing ----


def _descriptor(path: str) -> Optional[int]:
    """The descriptor that a path names, with which the program was started."""
    found = re.fullmatch(r"/(?:dev|proc/self|proc/thread-self)/fd/(\d{1,8})", path)
    return int(found.group(1)) if found else {"/dev/stdin": 0, "/dev/stdout": 1, "/dev/stderr": 2}.get(path)


class Output:
    """A file that takes its path's place when the block ends well; else what was there stays.

        with Output("table.csv") as file: file.write(b"...")

    A link is followed to a regular file, but not below the folder `received`, which somebody else may have made. Pipes and
    character devices are written directly."""

    def __init__(self, path: str, received: Optional[str] = None):
        self.path = path
        self._received = received
        self._target = path
        self._temporary: Optional[str] = None

    def __enter__(self) -> BinaryIO:
        try:
            self._file = self._begin()
        except OSError as e:
            raise self._refuse(reason(e)) from None
        return self._file

    def _refuse(self, why: str) -> Refusal:
        return Refusal(f"{self.path}: {why}", FAILED)

    def _begin(self) -> BinaryIO:
        given = _descriptor(self.path)
        if given is not None:
            return self._through(given)
        self._refuse_received_links()
        if not os.path.lexists(self.path):
            return self._beside(self.path, 0o666)
        if not os.path.exists(self.path):
            raise self._refuse("is a link that leads nowhere; remove it first")
        info = os.stat(self.path)
        if os.path.islink(self.path) and not stat.S_ISREG(info.st_mode):
            raise self._refuse("is a link to something that isn't a file; name that itself")
        if stat.S_ISDIR(info.st_mode):
            raise self._refuse("is a folder, a file's name is needed")
        for descriptor in (1, 2):  # as with `--csv out >out`
            if os.path.samestat(info, os.fstat(descriptor)) and _is_writable(descriptor):
                return self._through(descriptor)
        if stat.S_ISFIFO(info.st_mode) or stat.S_ISCHR(info.st_mode):
            return self._directly()
        if not stat.S_ISREG(info.st_mode):
            raise self._refuse("isn't a file; nothing is replaced")
        if not os.access(self.path, os.W_OK):
            raise self._refuse(os.strerror(errno.EACCES))
        return self._beside(os.path.realpath(self.path), stat.S_IMODE(info.st_mode) & 0o777)

    def _refuse_received_links(self) -> None:
        inside = self._received.rstrip("/") + "/" if self._received else ""
        for end in re.compile("/|$").finditer(self.path, len(inside)) if inside and self.path.startswith(inside) else ():
            if os.path.islink(self.path[: end.start()]):
                raise self._refuse("is a link, which isn't followed in a folder of somebody else; a file is needed")

    def _through(self, descriptor: int) -> BinaryIO:
        if not _is_writable(descriptor):
            raise self._refuse("that descriptor isn't open for writing")
        return open(os.dup(descriptor), "wb")

    def _directly(self) -> BinaryIO:
        """A pipe waits for its reader, until a signal comes."""
        while True:
            try:
                descriptor = os.open(self.path, os.O_WRONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY)
            except OSError as e:
                if e.errno != errno.ENXIO:
                    raise
                time.sleep(0.02)
                continue
            os.set_blocking(descriptor, True)
            return open(descriptor, "wb")

    def _beside(self, target: str, mode: int) -> BinaryIO:
        """A new file in the target's own folder, so that the rename stays within one file system. It is locked while its
        writer runs: an unlocked one was left by a program that was killed."""
        folder, name = os.path.split(target)
        _remove_left(folder or ".", name)
        temporary = f"{target}.{os.getpid()}-0.new"
        descriptor = os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, mode)
        self._target, self._temporary = target, temporary
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return open(descriptor, "wb")

    def _commit(self) -> None:
        self._file.flush()
        if self._temporary:
            os.rename(self._temporary, self._target)
            self._temporary = None

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException], _: Optional[TracebackType]) -> None:
        try:
            if error is None:
                self._commit()
        except OSError as e:
            error = e
        with contextlib.suppress(OSError):
            self._file.close()
        if self._temporary:
            os.unlink(self._temporary)
        if isinstance(error, KeyboardInterrupt):
            raise self._refuse("not written: stopped") from None
        if isinstance(error, OSError):
            raise self._refuse(reason(error)) from None


def _is_writable(descriptor: int) -> bool:
    try:
        flags = fcntl.fcntl(descriptor, fcntl.F_GETFL)
    except OSError:
        return False
    return not flags & os.O_PATH and flags & os.O_ACCMODE != os.O_RDONLY


def _remove_left(folder: str, name: str) -> None:
    for entry in os.listdir(folder):
        middle = entry[len(name) + 1 : -4].split("-")
        if not (entry.startswith(name + ".") and entry.endswith(".new") and len(middle) == 2 and all(m.isdecimal() for m in middle)):
            continue
        try:
            with open(os.open(os.path.join(folder, entry), os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                os.unlink(os.path.join(folder, entry))
        except OSError:
            continue
