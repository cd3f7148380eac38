#!/bin/sh
# Set-up on machines that lack something, and a tree that somebody else has built: what is missing, why it can't be had and what
# to do stand in a few lines; objects are linked in one order, whatever the locale.
# apt-get, sudo and id are stubs here; nothing is installed.
. tests/begin.sh
mkdir "$folder/bin"
for place in /usr/bin /bin; do ln -s $place/* "$folder/bin" 2>/dev/null; done
rm -f "$folder"/bin/apt* "$folder"/bin/dpkg* "$folder/bin/sudo" "$folder/bin/id"
stub() { # NAME LINES
  rm -f "$folder/bin/$1"
  printf '#!/bin/sh\n%s\n' "$2" >"$folder/bin/$1"
  chmod +x "$folder/bin/$1"
}
uid() { stub id "[ \"\$*\" = -u ] && echo $1 || exit 1"; }
says() { # WHAT MOST PATTERN...: set-up stops, with at most MOST lines and one for each pattern
  what=$1 most=$2
  shift 2
  PATH=$folder/bin CC=no-such-compiler sh .ci/setup build >"$folder/out" 2>"$folder/err" && fail "$what: set-up goes on"
  [ ! -s "$folder/out" ] || fail "$what: it says it is ready: $(cat "$folder/out")"
  for pattern; do grep -q -e "$pattern" "$folder/err" || fail "$what: no $pattern in: $(cat "$folder/err")"; done
  # the list of what is missing has a line for each thing
  lines=$(grep -vc '^  .*(Debian: ' "$folder/err")
  [ "$lines" -le "$most" ] || fail "$what: $lines lines: $(cat "$folder/err")"
}
named='^  the C compiler no-such-compiler (Debian: no-such-compiler)$'
uid 0
says 'not a Debian' 1 'setup: this is missing; install it and run make again:' "$named"
calls() { # NUMBER: apt-get was called so often, and told not to wait long
  [ "$(wc -l <"$folder/calls")" = "$1" ] || fail "apt-get was called otherwise than $1 times: $(cat "$folder/calls")"
  grep -vq 'Acquire::Retries=1 .*http::Timeout=10 .* timeout:3 attempts:1$' "$folder/calls" && fail "apt-get may take its time: $(cat "$folder/calls")"
  rm "$folder/calls"
}
count="echo \"\$* \$RES_OPTIONS\" >>'$folder/calls'"
resolving='for k in 1 2 3 4 5 6 7 8; do echo "E: Failed to fetch http://deb.debian.org/$k  Temporary failure resolving" >&2; done'
stub apt-get "$count; $resolving; exit 100"
says 'no network' 3 "apt-get can't reach the archive: is there a network?" "$named"
calls 1
stub apt-get "$count; case \$* in *update) $resolving; exit 0 ;; esac; echo 'E: Unable to locate package' >&2; exit 100"
says 'no network, no lists' 5 "apt-get can't reach the archive: is there a network?" "$named"
calls 2
# what may be absent costs no more
stub apt-get "$count; $resolving; exit 100"
rm -f "$folder/bin/clang-tidy"
absent() { # PATTERN
  PATH=$folder/bin sh .ci/setup ci >"$folder/out" 2>"$folder/err" && [ "$(cat "$folder/out")" = ready ] || fail "clang-tidy is a must"
  grep -q "$1" "$folder/err" && [ "$(wc -l <"$folder/err")" -le 2 ] || fail "without clang-tidy: $(cat "$folder/err")"
}
absent "^setup: clang-tidy can't be had without a network: those peers will be absent$"
calls 1
# what only looks like it: sudo's and a service's words, one dead archive of several, and the package that is installed all the same
provider="echo ':' >'$folder/bin/no-such-compiler'; chmod +x '$folder/bin/no-such-compiler'"
words="echo 'sudo: unable to resolve host here: Name or service not known' >&2; echo 'Failed to connect to bus: No such file' >&2"
dead="echo 'Hit:1 http://deb.debian.org/debian stable InRelease'; echo 'Err:2 http://dead.invalid x InRelease';
  echo 'W: Failed to fetch http://dead.invalid/x  Could not resolve' >&2"
goes_on() { # WHAT CALLS: the package comes; what else is missing is another matter
  PATH=$folder/bin CC=no-such-compiler sh .ci/setup build >"$folder/out" 2>"$folder/err"
  [ -e "$folder/bin/no-such-compiler" ] || fail "$1: set-up stops: $(cat "$folder/err")"
  grep -q 'is there a network' "$folder/err" && fail "$1: it is said to be the network: $(cat "$folder/err")"
  [ "$(grep -c '' "$folder/calls")" -ge "$2" ] || fail "$1: $(cat "$folder/calls")"
  rm -f "$folder/calls" "$folder/bin/no-such-compiler"
}
stub apt-get "$count; $words; $provider"
goes_on 'words on the way' 1
stub apt-get "$count; $words; case \$* in *update) : >'$folder/lists' ;; *) [ -e '$folder/lists' ] || exit 100; $provider ;; esac"
goes_on 'no lists, and words on the way' 3
for code in 0 100; do
  rm -f "$folder/lists"
  stub apt-get "$count; case \$* in *update) : >'$folder/lists'; $dead; exit $code ;; *) [ -e '$folder/lists' ] || exit 100; $provider ;; esac"
  goes_on "one dead archive, $code" 3
done
stub apt-get '[ "$LC_ALL" = C ] && echo "E: Unable to locate package no-such-compiler" >&2; exit 100'
says 'an unknown package' 6 '^E: Unable to locate' 'apt-get failed; as root: apt-get update && apt-get install no-such-compiler' "$named"
uid 1000
says 'no sudo' 1 'setup: this is missing; as root: apt-get install no-such-compiler' "$named"
absent '^setup: what some tests and tables compare with is missing; as root: apt-get install clang-tidy$'
# what only builds installs nothing
rm -f "$folder/calls"
uid 0
stub apt-get "$count"
PATH=$folder/bin CC=no-such-compiler sh .ci/setup look build >"$folder/out" 2>"$folder/err" && fail 'look: set-up goes on'
grep -q '^setup: this is missing; make demo installs it, or as root: apt-get install no-such-compiler' "$folder/err" || fail "look: $(cat "$folder/err")"
[ ! -e "$folder/calls" ] || fail 'look: apt-get was called'
uid 1000
stub sudo 'echo "sudo: a password is required" >&2; exit 1'
says 'a sudo that refuses' 6 "sudo doesn't let you install packages; ask for it, as root: apt-get install no-such-compiler" "$named"

# ---- a tree that somebody else has built ----
mkdir -p "$folder/theirs/bin"
chmod 755 "$folder"
if [ "$(id -u)" = 0 ]; then other='setpriv --reuid 65534 --regid 65534 --clear-groups'; else
  other=
  chmod a-w "$folder/theirs/bin" "$folder/theirs"
fi
for goal in all install clean; do
  $other ${MAKE:-make} --no-print-directory SETUP=no SAN= RT=posix BUILD="$folder/theirs" $goal >"$folder/out" 2>&1 && fail "$goal in a tree of theirs"
  [ "$(wc -l <"$folder/out")" = 1 ] && grep -q "theirs is not yours to write, it belongs to .*: make as that user, or .* make BUILD=another" "$folder/out" ||
    fail "$goal in a tree of theirs: $(cat "$folder/out")"
done
chmod u+w "$folder/theirs" "$folder/theirs/bin"

# ---- one order of linking, whatever the locale; where localedef can make one that sorts otherwise than C ----
order() { LOCPATH=$folder LC_ALL=$1 ${MAKE:-make} --no-print-directory SETUP=no -rpn clean | grep -E '^[A-Z]+_(C|O) :='; }
order C >"$folder/order"
grep -q '^APPS_C := apps/.* apps/' "$folder/order" || fail "no sources: $(cat "$folder/order")"
if localedef -c -i en_US -f UTF-8 "$folder/en_US.UTF-8" >"$folder/out" 2>&1; then
  order en_US.UTF-8 | cmp -s - "$folder/order" || fail 'the order of the linked objects depends on the locale'"'"'s'
fi
[ $failed = 0 ] && echo 'what is missing is said'
exit $failed
