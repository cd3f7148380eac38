#!/bin/sh
# A report's time grows as its participants do: eight times as many take no more than ten times the processor's time.
. tests/begin.sh
command -v gnuplot >/dev/null || { echo "SKIP: gnuplot (Debian: gnuplot-nox)"; exit 77; }
for people in 100 800; do
  "$BUILD/bin/ethd-study" "$BUILD/share/ethd/crowd.study" --simulate $people --out "$folder/$people" >"$folder/out" 2>&1 &&
    "$BUILD/bin/ethd-study" --merge "$folder/$people" >"$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
done
"${PYTHON:-python3}" - "$BUILD/bin/ethd-report" "$folder" <<'END_PYTHON'
import resource, subprocess, sys
def seconds(people):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.argv[1], f"{sys.argv[2]}/{people}", "--force"], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
few, many = seconds(100), seconds(800)
print(f"100 participants take {few:.2f} s, 800 take {many:.2f} s: {many / few:.1f} times as long")
sys.exit(many > 10 * few)
END_PYTHON
