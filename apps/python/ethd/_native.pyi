from typing import Any

ffi: Any  # made of libethd's headers by native.py
lib: Any
