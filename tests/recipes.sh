#!/bin/sh
# apps/README.md: its first block sets up a copy of the tree, and a home of its own; the others, of shell and of Python, run
# in order in the folder to which it goes, as they stand.
set -eu
. tests/begin.sh
fail() { echo "FAILED $*"; exit 1; }
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a study"; exit 77; }
python3=$(sh .ci/setup python) || fail "no python3 with numpy, which .ci/setup check brings"
tree=$PWD
mkdir -p "$folder/tree/apps" "$folder/bin" && cp -r apps/python apps/examples apps/config "$folder/tree/apps" && cp -r include LICENSE "$folder/tree"
ln -s "$(cd "$BUILD" && pwd)" "$folder/tree/build"
awk -v to="$folder" '
  /^```(sh|python)$/ { n++; out = sprintf("%s/%02d.%s", to, n, substr($0, 4)); next }
  /^```/ { out = "" }
  out != "" { print >out }' apps/README.md
# The set-up, with the build that is there, and with the distribution's packages in place of PyPI's.
printf '#!/bin/sh\nexec %s "$@"\n' "$(command -v "$python3")" >"$folder/bin/python3" && chmod +x "$folder/bin/python3"
make() { [ $# = 0 ]; }
export HOME="$folder" PATH="$folder/bin:$PATH" PIP_NO_INDEX=1 PIP_NO_BUILD_ISOLATION=0 PIP_DISABLE_PIP_VERSION_CHECK=1
cd "$folder/tree"
. "$folder/01.sh" >"$folder/out" 2>&1 || { cat "$folder/out"; fail "the set-up"; }
[ "$PWD" = "$folder/trials" ] || fail "the set-up goes to $PWD"
rm "$folder/01.sh"
count=0
for block in "$folder"/[0-9]*.*; do
  case $block in
    *.sh) sh -e "$block" >"$folder/out" 2>&1 || { cat "$block" "$folder/out"; fail "a block of shell"; } ;;
    *) python3 "$block" >"$folder/out" 2>&1 || { cat "$block" "$folder/out"; fail "a block of Python"; } ;;
  esac
  count=$((count + 1))
  [ "${block##*.}" != python ] || cp "$folder/out" "$folder/${block##*/}.out"
done
[ $count -ge 10 ] || fail "$count blocks"
grep -q '^True$' "$folder"/*.python.out || fail "the first torque isn't the recorded one"
grep -q '^[1-9][0-9]* ticks in C and in Python: True$' "$folder"/*.python.out || fail "a law in C and in Python differ: $(cat "$folder"/*.python.out)"
grep -q '^P01 smooth [1-9].* N at most$' "$folder"/*.python.out || fail "no tap of the study: $(cat "$folder"/*.python.out)"
[ -s study/report/report.html ] && [ -s swapped.csv ] && [ "$(wc -l <out.csv)" = 301 ] || fail "files are missing: $(ls)"
for picture in taps arm; do [ "$(cat "$tree/apps/plot/$picture.png" | wc -c)" -lt 100000 ] || fail "README's picture $picture.png is over 100 kB"; done
for link in $(grep -ohE '\]\([a-z][^):]*\)' "$tree/README.md" | tr -d '()]'); do [ -e "$tree/$link" ] || fail "README.md: $link isn't there"; done
for link in $(grep -ohE '\]\([a-z][^):]*\)' "$tree/apps/README.md" | tr -d '()]'); do [ -e "$tree/apps/$link" ] || fail "apps/README.md: $link isn't there"; done
echo "$count blocks"
