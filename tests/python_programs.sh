#!/bin/sh
# The programs in Python: what they share and their parts, as pytest asks them; --help comes at once, without the packages
# that the work needs.
set -u
python3=$(sh .ci/setup programs)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
fail() { echo "FAILED $*"; failed=1; }
PYTHONPATH=apps/python "$python3" -m pytest -q -p no:cacheprovider --basetemp "$work/pytest" tests/python || fail "pytest: exit $?"
for program in "$BUILD"/bin/ethd-*; do
  head -c 2 "$program" | grep -q '#!' || continue
  "$python3" -X importtime "$program" --help >"$work/help" 2>"$work/imports" || fail "${program##*/} --help: exit $?"
  grep -qE '\| +(numpy|scipy|shapely|ezdxf|svgelements)$' "$work/imports" && fail "${program##*/} --help imports what only the work needs"
  head -n 1 "$work/help" | grep -q "^Usage: ${program##*/} " || fail "${program##*/} --help: $(head -n 1 "$work/help")"
done
exit $failed
