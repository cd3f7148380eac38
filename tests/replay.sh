#!/bin/sh
# ethd-replay against a second derivation of the law, in another language.
set -eu
. tests/begin.sh
python3 tests/replay.py "$BUILD/bin/ethd-replay" "$folder"
