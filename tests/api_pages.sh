#!/bin/sh
# make doc: every public function has a page, and there is no warning. A function without a contract, or whose contract
# doesn't say which threads may call it, which failures it returns or in which unit its numbers are, is found.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
fail() { echo "FAILED $*"; failed=1; }
made() { B=$work/build VERSION=1 sh .packaging/doc >"$work/out" 2>&1; }
made || { cat "$work/out"; exit 1; }
cat "$work/out"
for name in $(cat tests/exported-symbols*.txt | grep '^ethd_[a-z]'); do
  grep -rqw "$name" "$work"/build/doc/html/*_8h.html || fail "no page has $name"
done
mkdir -p "$work/tree" && cp -r include .packaging "$work/tree" && cd "$work/tree" || exit 1
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
grep -q 'ethd_nothing_said(int x) (function) .* is not documented' "$work/out" || fail "ethd_nothing_said: $(cat "$work/out")"
grep -q "maths.h: ethd_no_thread: its contract doesn't say which thread" "$work/out" || fail "ethd_no_thread: $(cat "$work/out")"
grep -q "arm.h: ethd_no_failure: its contract doesn't say which failures it returns" "$work/out" || fail "ethd_no_failure: $(cat "$work/out")"
grep -q "arm.h: ethd_no_unit: its contract doesn't say in which unit its numbers are" "$work/out" || fail "ethd_no_unit: $(cat "$work/out")"
exit $failed
