#!/bin/sh
# Manual pages and completion: one page for each program, with every option that it has, and one for the library; no warning
# of man; installed and found.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
fail() { echo "FAILED $*"; failed=1; }
[ -z "${SAN:-}" ] || { echo "SKIP: pages are made of the programs without a sanitizer"; exit 77; }
$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$work/usr" install-files >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
pages=$work/usr/share/man
version=$(sed -n 's/.*define ETHD_VERSION "\(.*\)".*/\1/p' include/ethd/ethd.h)
count=0
for program in "$BUILD"/bin/ethd-*; do
  name=${program##*/} count=$((count + 1))
  [ -f "$pages/man1/$name.1" ] || { fail "no page of $name"; continue; }
  MANWIDTH=200 man -l --warnings -Tutf8 "$pages/man1/$name.1" 2>"$work/warned" | sed 's/\x1b\[[0-9;]*m//g; s/.\x08//g' >"$work/page"
  [ -s "$work/warned" ] && fail "$name.1: $(head -n 2 "$work/warned")"
  for option in $("$program" --help | grep -oE '(^|[ ,])--[a-z][-a-z]*' | tr -d ' ,' | sort -u); do
    sed 's/‐/-/g; s/−/-/g' "$work/page" | grep -q -e "$option" || fail "$name.1 has no $option"
  done
  torn=$("$program" --help | awk '/^Example/ { on = 1 } on && (/^--/ || length > 79)')
  [ -z "$torn" ] || fail "$name --help: an example is too long for a terminal: $torn"
  grep -q "libethd $version" "$work/page" || fail "$name.1 doesn't say its version"
  bash -c '. "$1" && complete -p "$2"' - "$work/usr/share/bash-completion/completions/$name" "$name" >"$work/log" 2>&1 ||
    fail "no completion of $name: $(cat "$work/log")"
done
man -l --warnings -Tutf8 "$pages/man3/libethd.3" >"$work/page" 2>"$work/warned"
[ ! -s "$work/warned" ] || fail "libethd.3: $(head -n 2 "$work/warned")"
for header in include/ethd/*.h; do
  grep -A1 -F "ethd/${header##*/}" "$pages/man3/libethd.3" | tail -n 1 | grep -q '^[A-Za-z].......' || fail "libethd.3 says nothing of ${header##*/}"
done
MANPATH=$pages man -w ethd-tap >"$work/found" 2>&1 && grep -q "$pages/man1/ethd-tap.1" "$work/found" || fail "man doesn't find ethd-tap: $(cat "$work/found")"

completed() { # WORDS...: what the last one becomes
  PATH=$work/usr/bin:$PATH bash -c '. "$1/usr/share/bash-completion/completions/ethd-tap"; shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _ethd "$1" "${@: -1}" "${@: -2:1}"; echo "${COMPREPLY[@]}"' - "$work" "$@"
}
[ "$(completed ethd-tap --tr)" = "--trace --transition" ] || fail "ethd-tap --tr: $(completed ethd-tap --tr)"
case $(completed ethd-tap --transition o) in offset) ;; *) fail "--transition o: $(completed ethd-tap --transition o)" ;; esac
case $(completed ethd-run --conf) in --config) ;; *) fail "ethd-run --conf: $(completed ethd-run --conf)" ;; esac
echo "$count pages of programs"
exit $failed
