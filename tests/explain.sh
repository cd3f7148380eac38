#!/bin/sh
# ethd-explain: a run and one that was interrupted have the same result; what it says about its plant is what ethd-tap and
# ethd-check say about the files that it writes. Bad input.
set -u
bin=$BUILD/bin
page=$(cd "$(dirname "$0")/../apps/explain" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
fail() { echo "FAILED: $*"; failed=1; }
explain() { "$bin/ethd-explain" --population 8 --generations 3 --taps 10 "$@"; }
cd "$folder" || exit 1

explain --work one.journal --out one >one.txt 2>err || fail "a search: $(cat err)"
head -c "$(($(wc -c <one.journal) / 2))" one.journal >two.journal
explain --work two.journal --out two >two.txt 2>err || fail "gone on: $(cat err)"
cmp one.txt two.txt && cmp one.plant two.plant && cmp one.journal two.journal || fail "a search that was ended differs"
explain --seed 2 >other.txt 2>err || fail "another seed: $(cat err)"
cmp -s one.txt other.txt && fail "another seed finds the same"

# Within the bounds that --priors states.
"$bin/ethd-explain" --priors >priors.txt
"${PYTHON:-python3}" - <<'END' || fail "a number is outside of its bounds"
rows = [line.split()[:4] for line in open("one.txt").read().split("unit\n")[1].split("\n\n")[0].splitlines()]
bounds = {w[0]: w[1:3] for w in (line.split() for line in open("priors.txt"))}
assert len(rows) == len(bounds) - 1 >= 20, rows
for name, value, low, high in rows:
    assert [low, high] == bounds[name], name
    assert float(low) <= float(value) <= float(high), name
END

# Table 1 by ethd-tap with the same fingers, the limits by ethd-check. Files have six digits, so last digits differ.
"$bin/ethd-tap" --plant ./one --taps 400 --seed 4294967297 --transition offset --speed low >tap.txt 2>err || fail "ethd-tap: $(cat err)"
"$bin/ethd-check" one.ini >check.txt 2>err || fail "ethd-check: $(cat err)"
"${PYTHON:-python3}" - <<'END' || fail "ethd-explain and the others differ"
import re
said = open("one.txt").read()
def line(text): return float(re.search(re.escape(text) + r"\s+(\S+)", said)[1])
tap = re.search(r"offset low .*", open("tap.txt").read())[0].replace("(", " ").replace(")", " ").split()
numbers = dict(zip(["ds", "ds_sd", "eps", "eps_sd"], map(float, tap[-4:])))
print(tap, numbers)
for key, text in [("ds", "mean Delta_s, low"), ("ds_sd", "sd of Delta_s, low"), ("eps", "mean eps, low"), ("eps_sd", "sd of eps, low")]:
    a, b = line(text), numbers[key]
    assert abs(a - b) <= 0.02 * b + 0.01, (text, a, b)
check = open("check.txt").read()
for key, text in [("contact.b_e", "largest stable B_e"), ("transition.b_d", "largest stable B_d")]:
    margin = float(re.search(key.replace(".", r"\.") + r"\s+\S+\s+<= \S+\s+(\S+)", check)[1])
    assert abs(line(text) - margin) <= 0.01 * margin, (text, line(text), margin)
END

# Tracking's limits are tried in time. Where a reading counts from where the ring was, they are those of a closed form.
explain --sample --without table --without claims --generations 8 --out sample >sample.txt 2>err || fail "--sample: $(cat err)"
"$bin/ethd-check" sample.ini >check.txt 2>err || fail "ethd-check: $(cat err)"
"${PYTHON:-python3}" - <<'END' || fail "tracking's limits aren't ethd-check's"
import re
said, check, compared = open("sample.txt").read(), open("check.txt").read(), 0
for key, text in [("tracking.k_t", "largest stable K_t, times the paper's"), ("tracking.b_t", "largest stable B_t")]:
    margin = float(re.search(key.replace(".", r"\.") + r"\s+\S+\s+<= \S+\s+(\S+)", check)[1])
    found = float(re.search(re.escape(text) + r"\s+(\S+)", said)[1])
    print(key, "in time", found, "closed form", margin)
    compared += margin < 8
    assert abs(found / margin - 1) < 0.03 or margin >= 8 and found >= 8, key
assert compared
END

# Any plant can be judged. The file that was written is the plant that was found, to the last digit.
"$bin/ethd-explain" --judge n >n.txt && grep -q '^n: 400 taps' n.txt || fail "n isn't judged"
"$bin/ethd-explain" --judge ./one | sed -n '/must be/,$p' >judged.txt
sed -n '/must be/,$p' one.txt | cmp - judged.txt || fail "the files that are written aren't the plant that was found"
grep -q 'largest stable K_e  *12.4 ' n.txt || fail "another limit of K_e on n than ethd-check's"

# The page's table is what --judge says.
"${PYTHON:-python3}" - "$page/README.md" >columns <<'END'
import sys
for row in open(sys.argv[1]):
    cells = [c.strip().strip("*") for c in row.replace("\\|", "").strip().strip("|").split("|")]
    if row.startswith("| ") and len(cells) == 6: print(*cells[2:])
END
column() { awk -v c="$1" 'NR > 1 { print $c }' columns; }
judge() { # PLANT: values to three digits, then how many lines are missed
  "$bin/ethd-explain" --judge "$1" >judged.txt || fail "--judge $1"
  "${PYTHON:-python3}" - <<'END'
import re
text = open("judged.txt").read()
for line in text.splitlines():
    value = re.match(r"  (?:table|claims|limits) .{47} *(\S+)", line)
    if value: print("none" if value[1] == "nan" else "%.3g" % float(value[1]))
print(re.search(r"(\d+) of 24", text)[1])
END
}
for plant in 1:n 2:p 3:"$page/rigid" 4:"$page/compliant"; do
  judge "${plant#*:}" >is
  column "${plant%%:*}" | cmp - is || fail "the page has another column for ${plant#*:}"
done

refuse() { # TEXT ARGUMENTS...
  text=$1
  shift
  "$bin/ethd-explain" "$@" >out 2>err
  is=$?
  [ $is = 2 ] && [ "$(wc -l <err)" -le 3 ] && grep -q -- "$text" err || fail "$* gives $is: $(cat err)"
}
refuse 'table, claims and limits' --without sentences
refuse 'nothing is left' --without table --without claims --without limits
refuse 'no such argument' n
refuse '8 to 512' --population 4
"$bin/ethd-explain" --population 8 --generations 3 --taps 10 --seed 3 --work one.journal >out 2>err
[ $? = 1 ] && grep -q 'another --work' err || fail "a journal of another search is taken: $(cat err)"
exit $failed
