#!/bin/sh
# Set-up on machines that lack something, and a tree that somebody else has built: what is missing, why it can't be had and what
# to do stand in a few lines; objects are linked in one order, whatever the locale.
# apt-get, sudo and id are stubs here; nothing is installed.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
fail() { printf 'FAILED %s\n' "$*"; failed=1; }
mkdir "$work/bin"
for place in /usr/bin /bin; do ln -s $place/* "$work/bin" 2>/dev/null; done
rm -f "$work"/bin/apt* "$work"/bin/dpkg* "$work/bin/sudo" "$work/bin/id"
stub() { # NAME LINES
  rm -f "$work/bin/$1"
  printf '#!/bin/sh\n%s\n' "$2" >"$work/bin/$1"
  chmod +x "$work/bin/$1"
}
uid() { stub id "[ \"\$*\" = -u ] && echo $1 || exit 1"; }
says() { # WHAT MOST PATTERN...: set-up stops; at most so many lines; one for each pattern
  what=$1 most=$2
  shift 2
  PATH=$work/bin CC=no-such-compiler sh .ci/setup build >"$work/out" 2>"$work/err" && fail "$what: set-up goes on"
  [ ! -s "$work/out" ] || fail "$what: it says it is ready: $(cat "$work/out")"
  for pattern; do grep -q -e "$pattern" "$work/err" || fail "$what: no $pattern in: $(cat "$work/err")"; done
  # the list of what is missing has a line for each thing
  lines=$(grep -vc '^  .*(Debian: ' "$work/err")
  [ "$lines" -le "$most" ] || fail "$what: $lines lines: $(cat "$work/err")"
}
named='^  the C compiler no-such-compiler (Debian: no-such-compiler)$'
uid 0
says 'not a Debian' 1 'setup: this is missing; install it and run make again:' "$named"
calls() { # NUMBER: apt-get was called so often, and told not to wait long
  [ "$(wc -l <"$work/calls")" = "$1" ] || fail "apt-get was called otherwise than $1 times: $(cat "$work/calls")"
  grep -vq 'Acquire::Retries=1 .*http::Timeout=10 .* timeout:3 attempts:1$' "$work/calls" && fail "apt-get may take its time: $(cat "$work/calls")"
  rm "$work/calls"
}
count="echo \"\$* \$RES_OPTIONS\" >>'$work/calls'"
resolving='for k in 1 2 3 4 5 6 7 8; do echo "E: Failed to fetch http://deb.debian.org/$k  Temporary failure resolving" >&2; done'
stub apt-get "$count; $resolving; exit 100"
says 'no network' 3 "apt-get can't reach the archive: is there a network?" "$named"
calls 1
stub apt-get "$count; case \$* in *update) $resolving; exit 0 ;; esac; echo 'E: Unable to locate package' >&2; exit 100"
says 'no network, no lists' 5 "apt-get can't reach the archive: is there a network?" "$named"
calls 2
# what may be absent costs no more
stub apt-get "$count; $resolving; exit 100"
rm -f "$work/bin/clang-tidy"
absent() { # PATTERN
  PATH=$work/bin sh .ci/setup ci >"$work/out" 2>"$work/err" && [ "$(cat "$work/out")" = ready ] || fail "clang-tidy is a must"
  grep -q "$1" "$work/err" && [ "$(wc -l <"$work/err")" -le 2 ] || fail "without clang-tidy: $(cat "$work/err")"
}
absent "^setup: clang-tidy can't be had without a network: those peers will be absent$"
calls 1
# what only looks like it: sudo's and a service's words, one dead archive of several, and the package that is installed all the same
provider="echo ':' >'$work/bin/no-such-compiler'; chmod +x '$work/bin/no-such-compiler'"
words="echo 'sudo: unable to resolve host here: Name or service not known' >&2; echo 'Failed to connect to bus: No such file' >&2"
dead="echo 'Hit:1 http://deb.debian.org/debian stable InRelease'; echo 'Err:2 http://dead.invalid x InRelease';
  echo 'W: Failed to fetch http://dead.invalid/x  Could not resolve' >&2"
goes_on() { # WHAT CALLS: the package comes; what else is missing is another matter
  PATH=$work/bin CC=no-such-compiler sh .ci/setup build >"$work/out" 2>"$work/err"
  [ -e "$work/bin/no-such-compiler" ] || fail "$1: set-up stops: $(cat "$work/err")"
  grep -q 'is there a network' "$work/err" && fail "$1: it is said to be the network: $(cat "$work/err")"
  [ "$(grep -c '' "$work/calls")" -ge "$2" ] || fail "$1: $(cat "$work/calls")"
  rm -f "$work/calls" "$work/bin/no-such-compiler"
}
stub apt-get "$count; $words; $provider"
goes_on 'words on the way' 1
stub apt-get "$count; $words; case \$* in *update) : >'$work/lists' ;; *) [ -e '$work/lists' ] || exit 100; $provider ;; esac"
goes_on 'no lists, and words on the way' 3
for code in 0 100; do
  rm -f "$work/lists"
  stub apt-get "$count; case \$* in *update) : >'$work/lists'; $dead; exit $code ;; *) [ -e '$work/lists' ] || exit 100; $provider ;; esac"
  goes_on "one dead archive, $code" 3
done
stub apt-get '[ "$LC_ALL" = C ] && echo "E: Unable to locate package no-such-compiler" >&2; exit 100'
says 'an unknown package' 6 '^E: Unable to locate' 'apt-get failed; as root: apt-get update && apt-get install no-such-compiler' "$named"
uid 1000
says 'no sudo' 1 'setup: this is missing; as root: apt-get install no-such-compiler' "$named"
absent '^setup: what some tests and tables compare with is missing; as root: apt-get install clang-tidy$'
# what only builds installs nothing
rm -f "$work/calls"
uid 0
stub apt-get "$count"
PATH=$work/bin CC=no-such-compiler sh .ci/setup look build >"$work/out" 2>"$work/err" && fail 'look: set-up goes on'
grep -q '^setup: this is missing; make demo installs it, or as root: apt-get install no-such-compiler' "$work/err" || fail "look: $(cat "$work/err")"
[ ! -e "$work/calls" ] || fail 'look: apt-get was called'
uid 1000
stub sudo 'echo "sudo: a password is required" >&2; exit 1'
says 'a sudo that refuses' 6 "sudo doesn't let you install packages; ask for it, as root: apt-get install no-such-compiler" "$named"

# ---- a tree that somebody else has built ----
mkdir -p "$work/theirs/bin"
chmod 755 "$work"
if [ "$(id -u)" = 0 ]; then other='setpriv --reuid 65534 --regid 65534 --clear-groups'; else
  other=
  chmod a-w "$work/theirs/bin" "$work/theirs"
fi
for goal in all install clean; do
  $other ${MAKE:-make} --no-print-directory SETUP=no SAN= RT=posix BUILD="$work/theirs" $goal >"$work/out" 2>&1 && fail "$goal in a tree of theirs"
  [ "$(wc -l <"$work/out")" = 1 ] && grep -q "theirs is not yours to write, it belongs to .*: make as that user, or .* make BUILD=another" "$work/out" ||
    fail "$goal in a tree of theirs: $(cat "$work/out")"
done
chmod u+w "$work/theirs" "$work/theirs/bin"

# ---- one order of linking, whatever the locale; where localedef can make one that sorts otherwise than C ----
order() { LOCPATH=$work LC_ALL=$1 ${MAKE:-make} --no-print-directory SETUP=no -rpn clean | grep -E '^[A-Z]+_(C|O) :='; }
order C >"$work/order"
grep -q '^APPS_C := apps/.* apps/' "$work/order" || fail "no sources: $(cat "$work/order")"
if localedef -c -i en_US -f UTF-8 "$work/en_US.UTF-8" >"$work/out" 2>&1; then
  order en_US.UTF-8 | cmp -s - "$work/order" || fail 'the order in which objects are linked is the locale'"'"'s'
fi
[ $failed = 0 ] && echo 'what is missing is said'
exit $failed
