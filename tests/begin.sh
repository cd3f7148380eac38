# For test scripts: a folder that goes when they end, failures that are told and counted, and refusals. Sourced first.
set -u
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failed=0
fail() { printf 'FAILED %s\n' "$*"; failed=1; }
says() { # FILE PATTERN...: each stands in it
  file=$1
  shift
  for pattern; do grep -q -e "$pattern" "$file" || { fail "no $pattern in:"; cat "$file"; }; done
}
# refuse CODE PATTERN COMMAND...: exit CODE (a glob) and one line on stderr, which matches; $folder/out and err hold what
# it says. The files and folders $kept stay as they are, or absent. With $try set, argp's "Try PROGRAM --help" may follow.
state() { [ -z "${kept:-}" ] || find $kept -print -type f -exec md5sum {} + 2>&1 | sort; }
refuse() {
  code=$1 pattern=$2 got=0
  shift 2
  state >"$folder/state"
  "$@" >"$folder/out" 2>"$folder/err" </dev/null || got=$?
  case $got in $code) ;; *) fail "$*: exit $got, not $code: $(head -c 999 "$folder/err")" ;; esac
  [ "$(sed "${try:+/^Try /d}" "$folder/err" | wc -l)" = 1 ] && grep -q -e "$pattern" "$folder/err" ||
    fail "$*: not one line with $pattern: $(head -c 999 "$folder/err")"
  state | cmp -s - "$folder/state" || fail "$*: $kept is changed"
}
