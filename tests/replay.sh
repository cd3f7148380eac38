#!/bin/sh
# ethd-replay against a second derivation of the law, in another language.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 tests/replay.py "$BUILD/bin/ethd-replay" "$folder"
