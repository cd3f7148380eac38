#!/bin/sh
# The programs in Python: what they share and their parts, as pytest asks them; --help comes at once, without the packages
# that the work needs.
. tests/begin.sh
python3=$(sh .ci/setup programs)
PYTHONPATH=apps/python "$python3" -m pytest -q -p no:cacheprovider --basetemp "$folder/pytest" tests/python || fail "pytest: exit $?"
for program in "$BUILD"/bin/ethd-*; do
  head -c 2 "$program" | grep -q '#!' || continue
  "$python3" -X importtime "$program" --help >"$folder/help" 2>"$folder/imports" || fail "${program##*/} --help: exit $?"
  grep -qE '\| +(numpy|scipy|shapely|ezdxf|svgelements)$' "$folder/imports" && fail "${program##*/} --help imports what only the work needs"
  head -n 1 "$folder/help" | grep -q "^Usage: ${program##*/} " || fail "${program##*/} --help: $(head -n 1 "$folder/help")"
done
exit $failed
