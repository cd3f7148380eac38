# For test scripts: a folder that goes when they end, and failures that are told and counted. Sourced first.
set -u
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failed=0
fail() { echo "FAILED $*"; failed=1; }
says() { # FILE PATTERN...: each stands in it
  file=$1
  shift
  for pattern; do grep -q -e "$pattern" "$file" || { fail "no $pattern in:"; cat "$file"; }; done
}
