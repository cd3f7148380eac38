#!/bin/sh
# The compiler's own proof that nothing marked ETHD_RT blocks; clang has it from version 20 on. ETHD_EFFECTS=pypi: where
# there is no such clang, the one in PyPI's ziglang, pinned, is asked.
. tests/begin.sh
set -f # options stand in a word

newest() {
  for clang in clang clang-25 clang-24 clang-23 clang-22 clang-21 clang-20; do
    command -v $clang >/dev/null && [ "$($clang -dumpversion | cut -d. -f1)" -ge 20 ] && echo $clang && return
  done
  [ "${ETHD_EFFECTS:-}" = pypi ] || return 1
  venv=$(sh .ci/venv ziglang ziglang==0.17.1) || return 1
  zig=$("$venv/bin/python" -c 'import os, ziglang; print(os.path.dirname(ziglang.__file__))') || return 1
  # It looks for headers of a C library of its own, unless it is told where those of this machine are.
  echo "$zig/zig clang --target=$(${CC:-cc} -dumpmachine) -isystem $zig/lib/include"
}
clang=$(newest) || {
  [ "${ETHD_EFFECTS:-}" != pypi ] || { echo "FAILED: no clang from PyPI"; exit 1; }
  echo "SKIP: function effects need clang 20 or later; the symbols of the control side are the proof"
  exit 77
}

check() { # SOURCE INCLUDES...
  source=$1
  shift
  locale=
  case $source in drivers/* | "$folder"/pointer.c | "$folder"/lock.c) locale='-include drivers/runtime/text/locale.h' ;; esac
  $clang -std=gnu11 -O1 -ffp-contract=off -fno-math-errno -D_GNU_SOURCE $locale "$@" \
    -fsyntax-only -Wfunction-effects -Werror=function-effects "$source"
}
for source in $(find lib drivers -name '*.c' ! -path '*/firmware/*'); do
  check "$source" -Iinclude -Ilib -Idrivers -Idrivers/runtime || fail "$source"
done

# What each kind of breach looks like: a call by name, one that is only inferred, one through a table, one after a sleep.
seed() { # NAME SOURCE SED
  sed "$3" "$2" >"$folder/$1.c"
  ! cmp -s "$2" "$folder/$1.c" || { fail "$1: the seed changes nothing"; return; }
  check "$folder/$1.c" -I"${2%/*}" -Iinclude -Ilib -Idrivers -Idrivers/runtime >"$folder/out" 2>&1 && fail "$1: the seeded breach isn't found"
  grep -q "$4" "$folder/out" || fail "$1: found otherwise: $(head -n 3 "$folder/out")"
}
seed heap lib/control/control.c 's|^  t.soft = take_clear(control);|  free(malloc(1));&|; 1i #include <stdlib.h>' "'free'"
seed inferred lib/arm.c 's|^static double wrap.*{|&\n  putchar(10);|; 1i #include <stdio.h>' "'wrap'"
seed pointer drivers/runtime/device/device.c 's|worse(status, \(d->at.i..driver->\)write(|worse(\1stop(d->at[i].state), \1write(|' 'non-.nonblocking'
seed lock drivers/runtime/loop/cycle.c 's|^  raise(&l->stats.ticks, 1);|  pthread_mutex_lock(0);&|' "'pthread_mutex_lock'"
exit $failed
