"""The library's failures as exceptions, with its own sentence."""
from typing import Any

from ethd._native import ffi, lib


class Error(Exception):
    """The library refused something. `status` is its number; the text says what was found and what is allowed."""

    def __init__(self, status: int, message: str):
        super().__init__(message)
        self.status = status


class Busy(Error):
    """The last post has not been taken yet: step, then post again."""


def text() -> Any:
    """Room for a message."""
    return ffi.new("char[]", 512)


def check(status: int, message: Any, what: str = "", plugins: str = "plugins=True") -> None:
    """Raises unless the call whose message this is went well. `what` is for a call without a message; `plugins` is what a
    user writes here in place of --plugins, the option of the library's programs."""
    if status == lib.ETHD_OK:
        return
    said = ffi.string(message).decode(errors="replace") if message is not None else ""
    said = said.replace("--plugins lets", plugins + " lets")
    sentence = said or (what + ": " if what else "") + ffi.string(lib.ethd_status_sentence(status)).decode()
    raise (Busy if status == lib.ETHD_STATUS_BUSY else Error)(status, sentence)


def check_error(status: int, error: Any, file: str = "") -> None:
    """The same for a call that left an ethd_error."""
    if status == lib.ETHD_OK:
        return
    if status > 0:
        check(status, None)
    message = text()
    error.status = status
    lib.ethd_error_text(file.encode() if file else ffi.NULL, error, message)
    check(status, message)
