"""What the tests of the Python package share. They are called with BUILD FOLDER: the build, and a folder to work in."""
import os
import sys

import ethd

build, folder = sys.argv[1:]
tree = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def refuses(text, call, kind=ethd.Error):
    try:
        call()
    except kind as e:
        assert text in str(e), (text, str(e))
        return
    raise AssertionError("not refused: " + text)


def write(name, text):
    with open(folder + "/" + name, "w") as out:
        out.write(text)
