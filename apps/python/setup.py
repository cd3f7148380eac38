import atexit
import os
import shutil
import sys
import tempfile

from setuptools import setup
from setuptools.command.sdist import sdist

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from native import HERE, TREE, library, version  # noqa: E402


class Sdist(sdist):
    """The licence stands at the tree's root, and at the root of what is given on."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        texts = [os.path.join(folder, "LICENSE") for folder in (HERE, TREE)]
        shutil.copy(next(text for text in texts if os.path.exists(text)), base_dir)


# The source tree stays as it is.
work = tempfile.mkdtemp(prefix="ethd-")
atexit.register(shutil.rmtree, work, ignore_errors=True)
setup(
    version=version(library()),
    cffi_modules=["native.py:ffi"],
    cmdclass={"sdist": Sdist},
    options={"build": {"build_base": work}, "egg_info": {"egg_base": work}},
)
