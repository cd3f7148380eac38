#!/bin/sh
# Manual pages and completion: one page for each program, with its name, every option that it has, each example on a line of
# its own, exit status and environment, and one for the library; no warning of man, or of mandoc where it is; installed and found.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: pages are made of the programs without a sanitizer"; exit 77; }
$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$folder/usr" install-files >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
pages=$folder/usr/share/man
version=$(sed -n 's/.*define ETHD_VERSION "\(.*\)".*/\1/p' include/ethd/ethd.h)
linted() { # PAGE
  command -v mandoc >/dev/null || return 0
  mandoc -Tlint -W warning "$1" >"$folder/warned" 2>&1 || fail "$(head -n 2 "$folder/warned")"
}
day=$(date -u -d "$(sed -n 's/^ -- .*>  //p' .packaging/debian/changelog | head -n 1)" +%Y-%m-%d)
count=0
for program in "$BUILD"/bin/ethd-*; do
  name=${program##*/} count=$((count + 1))
  [ -f "$pages/man1/$name.1" ] || { fail "no page of $name"; continue; }
  MANWIDTH=200 man -l --warnings -Tutf8 "$pages/man1/$name.1" 2>"$folder/warned" | sed 's/\x1b\[[0-9;]*m//g; s/.\x08//g' >"$folder/page"
  [ -s "$folder/warned" ] && fail "$name.1: $(head -n 2 "$folder/warned")"
  for option in $("$program" --help | grep -oE '(^|[ ,])--[a-z][-a-z]*' | tr -d ' ,' | sort -u); do
    sed 's/‐/-/g; s/−/-/g' "$folder/page" | grep -q -e "$option" || fail "$name.1 has no $option"
  done
  # what stands as it is, examples first of all, is neither broken by argp nor run together in the page
  ARGP_HELP_FMT=rmargin=1000 "$program" --help | awk '/--version  / { on = 1; next } on && /^  / { sub(/^  /, ""); print }' >"$folder/lines"
  torn=$(awk 'length > 76' "$folder/lines")
  [ -z "$torn" ] || fail "$name --help: too long for a terminal: $torn"
  sed 's/‐/-/g; s/−/-/g; s/^ *//' "$folder/page" >"$folder/plain"
  grep "^$name " "$folder/lines" >"$folder/examples"
  grep -vxFf "$folder/plain" "$folder/examples" >"$folder/torn" && fail "$name.1 tears an example: $(cat "$folder/torn")"
  [ -s "$folder/examples" ] || fail "$name --help has no example"
  sed -n '/^NAME$/{n;p;}' "$folder/plain" | tr -s ' ' | grep -q "^$name - " || fail "$name.1 is called $(sed -n '/^NAME$/{n;p;}' "$folder/plain")"
  for section in SYNOPSIS DESCRIPTION OPTIONS 'EXIT STATUS' EXAMPLES 'SEE ALSO'; do
    grep -qx "$section" "$folder/plain" || fail "$name.1 has no $section"
  done
  grep -q "^.TH .* \"1\" $day " "$pages/man1/$name.1" || fail "$name.1 isn't of $day: $(grep "^.TH" "$pages/man1/$name.1")"
  linted "$pages/man1/$name.1"
  grep -q "libethd $version" "$folder/page" || fail "$name.1 doesn't say its version"
  bash -c '. "$1" && complete -p "$2"' - "$folder/usr/share/bash-completion/completions/$name" "$name" >"$folder/log" 2>&1 ||
    fail "no completion of $name: $(cat "$folder/log")"
done
man -l --warnings -Tutf8 "$pages/man3/libethd.3" >"$folder/page" 2>"$folder/warned"
[ ! -s "$folder/warned" ] || fail "libethd.3: $(head -n 2 "$folder/warned")"
linted "$pages/man3/libethd.3"
# A variable that a program reads is in a page.
for variable in $(grep -rhoE 'getenv\("ETHD_[A-Z_]*' apps drivers --include='*.c' | sed 's/.*"//' | sort -u); do
  [ $variable = ETHD_XENOMAI_VERSION_FILE ] || grep -qx '\\fB'$variable'\\fR' "$pages"/man1/*.1 || fail "no page has $variable"
done
for header in include/ethd/*.h; do
  grep -A1 -F "ethd/${header##*/}" "$pages/man3/libethd.3" | tail -n 1 | grep -q '^[A-Za-z].......' || fail "libethd.3 says nothing of ${header##*/}"
done
MANPATH=$pages man -w ethd-tap >"$folder/found" 2>&1 && grep -q "$pages/man1/ethd-tap.1" "$folder/found" || fail "man doesn't find ethd-tap: $(cat "$folder/found")"

completed() { # WORDS...: what the last one becomes
  PATH=$folder/usr/bin:$PATH bash -c '. "$1/usr/share/bash-completion/completions/ethd-tap"; shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _ethd "$1" "${@: -1}" "${@: -2:1}"; echo "${COMPREPLY[@]}"' - "$folder" "$@"
}
[ "$(completed ethd-tap --tr)" = "--trace --transition" ] || fail "ethd-tap --tr: $(completed ethd-tap --tr)"
while read -r expected words; do # what an option takes, in its short and long form; - for nothing of ours
  found=$(completed $words | tr ' ' ,)
  [ "${found:--}" = "$expected" ] || fail "$words: completed to $found, not to $expected"
done <<END
q,n,b,p ethd-tap --plant =
q,n,b,p ethd-tap -p =
q,n,b,p ethd-identify --base =
paper ethd-tap --validity p
wall ethd-tune --prefer w
low,high ethd-tap -s low,h
abrupt,offset ethd-tap -t abrupt,o
- ethd-scene -t o
- ethd-tap --csv o
END
case $(completed ethd-tap --transition o) in offset) ;; *) fail "--transition o: $(completed ethd-tap --transition o)" ;; esac
case $(completed ethd-run --conf) in --config) ;; *) fail "ethd-run --conf: $(completed ethd-run --conf)" ;; esac
echo "$count pages of programs"
exit $failed
