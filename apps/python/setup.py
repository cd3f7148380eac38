import atexit
import os
import shutil
import sys
import tempfile

from setuptools import setup

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from native import library, version  # noqa: E402

# The source tree stays as it is.
work = tempfile.mkdtemp(prefix="ethd-")
atexit.register(shutil.rmtree, work, ignore_errors=True)
setup(
    version=version(library()),
    cffi_modules=["native.py:ffi"],
    options={"build": {"build_base": work}, "egg_info": {"egg_base": work}},
)
