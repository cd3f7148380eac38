#!/bin/sh
# ethd-convert: CSV and MCAP hold what the recording holds, as others read it.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
convert=$BUILD/bin/ethd-convert
failed=0
fail() { echo "FAILED $*"; failed=1; }
printf 'wait 0.5\ntransition smooth\nset contact.k_e 2000\nwait 9\n' |
  "$BUILD/bin/ethd-run" --virtual --duration 2 --record "$folder/rec" >/dev/null || fail "recording"
for out in rec.csv rec.mcap; do "$convert" "$folder/rec" "$folder/$out" >"$folder/log" 2>&1 || fail "$out: $(cat "$folder/log")"; done

# ---- refusals: one line, and what was there stays ----
refuse() { # PATTERN ARGUMENTS...
  pattern=$1
  shift
  "$convert" "$@" >"$folder/log" 2>&1
  code=$?
  [ $code = 2 ] && grep -q -e "$pattern" "$folder/log" || fail "$*: exit $code: $(cat "$folder/log")"
}
refuse 'ends in .csv or .mcap' "$folder/rec" "$folder/rec.txt"
refuse 'tick.npy' "$folder/nowhere" "$folder/x.csv"
refuse 'are needed' "$folder/rec"
cp -r "$folder/rec" "$folder/cut"
truncate -s 1000 "$folder/cut/tick.npy"
echo old >"$folder/old.mcap"
refuse 'tick.npy' "$folder/cut" "$folder/old.mcap"
[ "$(cat "$folder/old.mcap")" = old ] || fail "a failed conversion left its mark"

# ---- what others read ----
python3=$(sh .ci/setup python) || { echo "SKIP: no python3 with numpy"; exit 77; }
venv=$(sh .ci/venv mcap mcap==1.6.0 jsonschema==4.23.0) || { [ $failed = 0 ] || exit 1; echo "SKIP: the Python package mcap can't be had"; exit 77; }
cat >"$folder/read.py" <<'EOF2'
import csv, json, math, subprocess, sys
import jsonschema
import numpy as np
from mcap.reader import make_reader
folder = sys.argv[1]
rows = np.load(folder + "/rec/tick.npy")
events = list(csv.DictReader(open(folder + "/rec/events.csv")))

def flat(row):
    for name in rows.dtype.names:
        yield from np.ravel(row[name]).tolist()

table = list(csv.reader(open(folder + "/rec.csv")))
assert len(table) == len(rows) + 1 and {"time_ns", "q_1_rad", "tau_2_nm", "vf_1_mps"} <= set(table[0])
for row, line in zip(rows, table[1:]):
    for value, text in zip(flat(row), line, strict=True):
        assert (text == "" and math.isnan(value)) or float(text) == value, (value, text)

reader = make_reader(open(folder + "/rec.mcap", "rb"), validate_crcs=True)
statistics = reader.get_summary().statistics
assert statistics.message_count == len(rows) + len(events) and len(reader.get_summary().chunk_indexes) >= 2
ticks = [(m.log_time, json.loads(m.data)) for _, c, m in reader.iter_messages(topics=["/tick"])]
said = [json.loads(m.data) for _, c, m in reader.iter_messages(topics=["/events"])]
assert len(ticks) == len(rows)
left_out = set()
for row, (now, message) in zip(rows, ticks):
    defined = [name for name in rows.dtype.names if np.isfinite(row[name]).all()]
    assert now == row["time_ns"] and list(message) == defined
    assert all(message[name] == row[name].tolist() for name in defined)
    left_out |= set(rows.dtype.names) - set(defined)
assert "rf" in left_out and "tau" not in left_out, left_out

# each message is JSON, and what its schema says; a schema that lets everything pass says nothing
def no_constant(word):
    raise ValueError(word)

kinds = {}
for schema, _, m in reader.iter_messages():
    judge = kinds.setdefault(schema.name, jsonschema.Draft7Validator(json.loads(schema.data)))
    judge.validate(json.loads(m.data, parse_constant=no_constant))
tick = kinds["ethd.tick"]
assert set(tick.schema["properties"]) == set(rows.dtype.names) and set(kinds) == {"ethd.tick", "ethd.event"}
assert not tick.is_valid({"d_re": None}) and not tick.is_valid({"q": [0, None]}) and not tick.is_valid({"beta": "1"})
assert [(str(e["row"]), e["kind"], e["detail"]) for e in said] == [(e["row"], e["kind"], e["detail"]) for e in events]
middle = rows["time_ns"][len(rows) // 2]
assert next(reader.iter_messages(topics=["/tick"], starting_at=int(middle)))[2].log_time == middle

# a sensor that was broken for a tick: what a field of two numbers lacks, no other field does
broken = np.load(folder + "/broken/tick.npy", mmap_mode="r+")
broken["q"][3, 1], broken["rays"][3, :2] = np.nan, (np.inf, -np.inf)
broken.flush()
with open(folder + "/broken/events.csv", "wb") as file:
    file.write(b'row,kind,detail\n0,setup,offset\n0,fault,"caf\xc3\xa9 \xff\xe2\x82 ""\x01"" \\"\n')
subprocess.run([sys.argv[2], folder + "/broken", folder + "/broken.mcap"], check=True, stdout=subprocess.DEVNULL)
words = [json.loads(m.data)["detail"] for _, _, m in make_reader(open(folder + "/broken.mcap", "rb")).iter_messages(topics=["/events"])]
assert words == ["offset", 'caf\u00e9 \ufffd\ufffd\ufffd " " \\'], words
third = [m.data for _, _, m in make_reader(open(folder + "/broken.mcap", "rb")).iter_messages(topics=["/tick"])][3]
third = json.loads(third, parse_constant=no_constant)
tick.validate(third)
assert set(ticks[3][1]) - set(third) == {"q", "rays"} and third["tau"] == rows[3]["tau"].tolist()
print(f"{len(rows)} ticks and {len(events)} events, as CSV and as MCAP")
EOF2
cp -r "$folder/rec" "$folder/broken"
"$venv/bin/python" "$folder/read.py" "$folder" "$convert" || fail "others read something else"
exit $failed
