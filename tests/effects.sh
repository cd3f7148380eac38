#!/bin/sh
# The compiler's own proof that nothing marked ETHD_RT blocks; clang has it from version 20 on.
set -u
for clang in clang clang-25 clang-24 clang-23 clang-22 clang-21 clang-20; do
  command -v $clang >/dev/null || continue
  [ "$($clang -dumpversion | cut -d. -f1)" -ge 20 ] || continue
  failed=0
  for source in $(find lib drivers -name '*.c'); do
    $clang -std=gnu11 -O1 -ffp-contract=off -fno-math-errno -D_GNU_SOURCE -Iinclude -Ilib -Idrivers \
      -fsyntax-only -Wfunction-effects -Werror=function-effects "$source" || failed=1
  done
  exit $failed
done
echo "SKIP: function effects need clang 20 or later; the symbols of the control side are the proof"
exit 77
