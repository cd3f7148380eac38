#!/bin/sh
# make doc: every public function has a page, and there is no warning. A function without a contract, or whose contract
# doesn't say which threads may call it, which failures it returns, or the unit of its numbers, is found.
. tests/begin.sh
. tests/declared.sh
made() { B=$folder/build VERSION=1 sh .packaging/doc >"$folder/out" 2>&1; }
made || { cat "$folder/out"; exit 1; }
cat "$folder/out"
for name in $(declared); do
  grep -rqw "$name" "$folder"/build/doc/html/*_8h.html || fail "no page has $name"
done
mkdir -p "$folder/tree" && cp -r include .packaging "$folder/tree" && cd "$folder/tree" || exit 1
cat >>include/ethd/maths.h <<'END'

ETHD_API void ethd_nothing_said(int x);

/* Says what it does. */
ETHD_API void ethd_no_thread(int x);
END
cat >>include/ethd/arm.h <<'END'

/* Says what it does. [any] */
ETHD_API ethd_status ethd_no_failure(int x);

/* Says what it does. [any] */
ETHD_API void ethd_no_unit(double x);
END
made && fail "functions without a contract pass"
grep -q 'ethd_nothing_said(int x) (function) .* is not documented' "$folder/out" || fail "ethd_nothing_said: $(cat "$folder/out")"
grep -q "maths.h: ethd_no_thread: its contract doesn't say which thread" "$folder/out" || fail "ethd_no_thread: $(cat "$folder/out")"
grep -q "arm.h: ethd_no_failure: its contract doesn't say which failures it returns" "$folder/out" || fail "ethd_no_failure: $(cat "$folder/out")"
grep -q "arm.h: ethd_no_unit: its contract doesn't say in which unit its numbers are" "$folder/out" || fail "ethd_no_unit: $(cat "$folder/out")"
exit $failed
