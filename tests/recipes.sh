#!/bin/sh
# apps/README.md: its blocks of shell run in order in one folder, as they stand; its blocks of Python likewise, where
# tests/python has left a module to run them with.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED $*"; exit 1; }
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a study"; exit 77; }
python3=$(sh .ci/setup python) || fail "no python3 with numpy, which .ci/setup check brings"
tree=$PWD
mkdir -p "$work/tree/apps" "$work/mine" && cp -r apps/python "$work/tree/apps" && cp -r include "$work/tree"
"$python3" -m venv --system-site-packages "$work/venv"
ETHD_BUILD=$BUILD "$work/venv/bin/pip" -q --disable-pip-version-check install --no-build-isolation --no-deps "$work/tree/apps/python" >"$work/pip" 2>&1 ||
  { cat "$work/pip"; fail "pip install"; }
awk -v to="$work" '
  /^```(sh|python)$/ { n++; out = sprintf("%s/%02d.%s", to, n, substr($0, 4)); next }
  /^```/ { out = "" }
  out != "" { print >out }' apps/README.md
printf 'Name: ethd\nDescription: the tree\nVersion: 0\nCflags: -I%s/include\n' "$tree" >"$work/ethd.pc"
export PATH="$BUILD/bin:$PATH" PKG_CONFIG_PATH="$work"
cd "$work/mine"
count=0
for block in "$work"/[0-9]*.*; do
  case $block in
    *.sh) sh -e "$block" >"$work/out" 2>&1 || { cat "$block" "$work/out"; fail "a block of shell"; } ;;
    *) "$work/venv/bin/python" "$block" >"$work/out" 2>&1 || { cat "$block" "$work/out"; fail "a block of Python"; } ;;
  esac
  count=$((count + 1))
  [ "${block##*.}" != python ] || cp "$work/out" "$work/${block##*/}.out"
done
[ $count -ge 10 ] || fail "$count blocks"
grep -q '^True$' "$work"/*.python.out || fail "the first torque isn't the recorded one"
[ -s study/report/report.html ] && [ -s swapped.mcap ] && [ "$(wc -l <out.csv)" = 301 ] || fail "files are missing: $(ls)"
[ "$(cat "$tree"/apps/plot/offset.png | wc -c)" -lt 100000 ] || fail "README's picture is over 100 kB"
for link in $(grep -ohE '\]\([a-z][^):]*\)' "$tree/README.md" | tr -d '()]'); do [ -e "$tree/$link" ] || fail "README.md: $link isn't there"; done
for link in $(grep -ohE '\]\([a-z][^):]*\)' "$tree/apps/README.md" | tr -d '()]'); do [ -e "$tree/apps/$link" ] || fail "apps/README.md: $link isn't there"; done
echo "$count blocks"
