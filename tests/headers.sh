#!/bin/sh
# Every public header stands alone: strict C11 and C++17, no warning, nothing of an operating system.
set -u
failed=0
strict='-Wall -Wextra -Wpedantic -Wshadow -Werror -Iinclude -fsyntax-only'
alone() { # HEADER COMPILER...
  header=$1
  shift
  printf '#include <ethd/%s>\n#include <ethd/%s>\n' "$header" "$header" | "$@" $strict - || {
    echo "$header: not alone with $*"
    failed=1
  }
}
count=0
for path in include/ethd/*.h; do
  [ -f "$path" ] || { echo "include/ethd holds no header"; exit 1; }
  header=${path##*/}
  count=$((count + 1))
  for cc in "$CC" clang; do
    if command -v ${cc%% *} >/dev/null; then alone "$header" $cc -std=c11 -Wstrict-prototypes -x c; fi
  done
  alone "$header" $CXX -std=c++17 -x c++
  if grep -nEH '# *include *[<"](pthread|xeno|cobalt|mercury|boilerplate|modbus|unistd|sys/|linux/)' "$path"; then
    echo "$header: includes a platform's header"
    failed=1
  fi
done
echo "$count headers"
exit $failed
