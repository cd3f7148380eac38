#!/bin/sh
# The compiler's own proof that nothing of the control side blocks; clang has it from version 20 on.
set -u
for clang in clang clang-25 clang-24 clang-23 clang-22 clang-21 clang-20; do
  command -v $clang >/dev/null || continue
  [ "$($clang -dumpversion | cut -d. -f1)" -ge 20 ] || continue
  failed=0
  for source in lib/*.c; do
    $clang -std=gnu11 -O1 -ffp-contract=off -fno-math-errno -Iinclude -Ilib -fsyntax-only \
      -Wfunction-effects -Wno-perf-constraint-implies-noexcept -Werror "$source" || failed=1
  done
  exit $failed
done
echo "SKIP: function effects need clang 20 or later; the symbols of the control side are the proof"
exit 77
