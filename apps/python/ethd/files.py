"""Files of folders that somebody else may have made: below the folder no link is followed, and only regular files are read."""
import os
import stat
from typing import BinaryIO


def _is_link(name: str, folder: int) -> bool:
    try:
        return stat.S_ISLNK(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode)
    except OSError:
        return False


def _open(folder: str, *names: str) -> int:
    """A descriptor of folder/names..., each of which is a single name. The folder itself may be reached through links."""
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
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise ValueError(f"{os.path.join(folder, *names)}: isn't a file, which is needed")
    return open(descriptor, "rb")


def has_hole(file: BinaryIO, end: int) -> bool:
    """Whether the file's first `end` bytes have a part that was never written and takes no room on the disk."""
    descriptor = file.fileno()
    at, size = os.lseek(descriptor, 0, os.SEEK_CUR), os.fstat(descriptor).st_size
    hole = os.lseek(descriptor, 0, os.SEEK_HOLE) if size else 0
    os.lseek(descriptor, at, os.SEEK_SET)
    return hole < min(end, size)
