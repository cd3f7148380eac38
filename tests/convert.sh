#!/bin/sh
# ethd-convert: CSV and MCAP hold what the recording holds, as others and ethd-replay read it.
. tests/begin.sh
convert=$BUILD/bin/ethd-convert
printf 'wait 0.5\ntransition smooth\nset contact.k_e 2000\nwait 9\n' |
  "$BUILD/bin/ethd-run" --virtual --duration 2 --record "$folder/rec" >/dev/null || fail "recording"
"$convert" "$folder/rec" "$folder/rec.csv" >"$folder/log" 2>&1 || fail "rec.csv: $(cat "$folder/log")"

# ---- refusals: one line, and what was there stays ----
try=yes
refuse 2 'ends in .csv or .mcap' "$convert" "$folder/rec" "$folder/rec.txt"
refuse 2 'tick.npy' "$convert" "$folder/nowhere" "$folder/x.csv"
refuse 2 'are needed' "$convert" "$folder/rec"
cp -r "$folder/rec" "$folder/cut"
truncate -s 1000 "$folder/cut/tick.npy"
echo old >"$folder/old.csv"
refuse 2 'tick.npy' "$convert" "$folder/cut" "$folder/old.csv"
[ "$(cat "$folder/old.csv")" = old ] || fail "a failed conversion left its mark"

# ---- CSV: what the recording holds; ethd-replay reads it, and answers as the recorded controller did ----
python3=$(sh .ci/setup python) || { echo "SKIP: no python3 with numpy"; exit 77; }
"$BUILD/bin/ethd-tap" --taps 2 --transition offset --speed low --record "$folder/taps" >/dev/null || fail "taps"
printf 'wait 9\n' | "$BUILD/bin/ethd-run" --duration 0.2 --record "$folder/real" >/dev/null 2>&1
for name in taps real; do "$convert" "$folder/$name" "$folder/$name.csv" >"$folder/log" 2>&1 || fail "$name: $(cat "$folder/log")"; done
"$BUILD/bin/ethd-replay" --config "$folder/rec/config.ini" --in "$folder/rec.csv" --out "$folder/again.csv" >"$folder/log" 2>&1 ||
  fail "replay: $(cat "$folder/log")"
cat >"$folder/table.py" <<'EOF2'
import csv, datetime, sys, time
import numpy as np
folder = sys.argv[1]

def table(name):
    with open(f"{folder}/{name}") as file:
        return list(csv.DictReader(file))

def column(rows, name):
    return np.array([float(row[name] or "nan") for row in rows])

rows, found = np.load(folder + "/rec/tick.npy"), table("rec.csv")
assert len(rows) == len(found) > 1900
for field, names in dict(q="q1_rad q2_rad", x="x_m y_m", vf="vxf_mps vyf_mps", tau="tau1_Nm tau2_Nm", fd="fdx_N fdy_N", eps_q_dot="depsq1_radps depsq2_radps",
                         beta="beta", rf="rf_m", state="state", object="object", learnt="learnt1 learnt2 learnt3 learnt4").items():
    for i, name in enumerate(names.split()):
        assert np.array_equal(rows[field].reshape(len(rows), -1)[:, i], column(found, name), equal_nan=True), name
assert all(float(row["t_s"]) == t / 1e9 for row, t in zip(found, rows["time_ns"]))
# a missing number is an empty cell, also where the device didn't give it; a whole real number keeps its point
assert {row["dq1_radps"] for row in found} == {row["body2_angle_rad"] for row in found} == {row["utc_s"] for row in found} == {""}
assert [row["ring_x_m"] != "" for row in found] == [bool(have & 32) for have in rows["have"]] and (rows["have"] & 32).any()
assert found[0]["t_s"] == "0.0" and found[0]["beta"] == "1.0" and found[0]["tick"] == "0"

# the torques are the recorded ones until the first command, which the file doesn't hold
again = table("again.csv")
for name in "tau1_Nm", "tau2_raw_Nm", "fex_N", "beta", "d_re_m", "x_m", "vy_mps", "epsq2_rad":
    assert np.array_equal(column(found[:501], name), column(again[:501], name), equal_nan=True), name

# where the recorded time starts again, the table's goes on
taps, time_ns = table("taps.csv"), np.load(folder + "/taps/tick.npy")["time_ns"]
starts = np.flatnonzero(np.diff(time_ns) < 0) + 1
steps = np.diff(column(taps, "t_s"))
assert len(starts) == 1 and np.allclose(steps[starts - 1], 1e-3) and np.allclose(steps, 1e-3)

# a real device's recording knows the time of day
real = table("real.csv")
utc, t = column(real, "utc_s"), column(real, "t_s")
assert len(real) > 50 and abs(utc[0] - time.time()) < 60 and np.allclose(utc - utc[0], t - t[0], atol=1e-6)
print(f"{len(rows)} ticks as CSV")
EOF2
"$python3" "$folder/table.py" "$folder" || fail "the table holds something else"

# ---- a long recording takes little memory ----
cat >"$folder/long.py" <<'EOF2'
import resource, subprocess, sys
import numpy as np
from numpy.lib import format
folder, convert = sys.argv[1:]
rows = np.load(folder + "/rec/tick.npy")
subprocess.run(["cp", "-r", folder + "/rec", folder + "/long"], check=True)
with open(folder + "/long/tick.npy", "wb") as file:
    format.write_array_header_1_0(file, {"descr": format.dtype_to_descr(rows.dtype), "fortran_order": False, "shape": (50 * len(rows),)})
    for _ in range(50):
        rows.tofile(file)
        rows["time_ns"] += 2002000000
subprocess.run([convert, folder + "/long", folder + "/long.csv"], check=True, stdout=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3
assert sum(1 for _ in open(folder + "/long.csv")) == 50 * len(rows) + 1
assert used < 100, used
print(f"{50 * len(rows)} ticks in {used:.0f} MB of memory")
EOF2
"$python3" "$folder/long.py" "$folder" "$convert" || fail "a long recording"
rm -rf "$folder/long" "$folder/long.csv"

# ---- MCAP, as its own reader reads it ----
if ! "$python3" -c 'import mcap' 2>/dev/null; then
  "$convert" "$folder/rec" "$folder/rec.mcap" >"$folder/log" 2>&1
  [ $? = 1 ] && [ "$(wc -l <"$folder/log")" = 1 ] && grep -q "needs the Python package mcap: .*pip install './apps/python\[mcap\]'" "$folder/log" ||
    fail "without mcap: $(cat "$folder/log")"
fi
venv=$(sh .ci/venv mcap mcap==1.6.0 jsonschema==4.23.0) || { [ $failed = 0 ] || exit 1; echo "SKIP: the Python package mcap can't be had"; exit 77; }
"$venv/bin/python" "$convert" "$folder/rec" "$folder/rec.mcap" >"$folder/log" 2>&1 || fail "MCAP: $(cat "$folder/log")"
"$venv/bin/python" "$convert" "$folder/real" "$folder/real.mcap" >"$folder/log" 2>&1 || fail "MCAP: $(cat "$folder/log")"
cat >"$folder/read.py" <<'EOF2'
import csv, json, subprocess, sys, time
import jsonschema
import numpy as np
from mcap.reader import make_reader
folder = sys.argv[1]
rows = np.load(folder + "/rec/tick.npy")
events = list(csv.DictReader(open(folder + "/rec/events.csv")))

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
subprocess.run([sys.executable, sys.argv[2], folder + "/broken", folder + "/broken.mcap"], check=True, stdout=subprocess.DEVNULL)
words = [json.loads(m.data)["detail"] for _, _, m in make_reader(open(folder + "/broken.mcap", "rb")).iter_messages(topics=["/events"])]
assert words == ["offset", 'caf\u00e9 \ufffd\ufffd "\x01" \\'], words
third = [m.data for _, _, m in make_reader(open(folder + "/broken.mcap", "rb")).iter_messages(topics=["/tick"])][3]
third = json.loads(third, parse_constant=no_constant)
tick.validate(third)
assert set(ticks[3][1]) - set(third) == {"q", "rays"} and third["tau"] == rows[3]["tau"].tolist()
message = next(make_reader(open(folder + "/real.mcap", "rb")).iter_messages())[2]
assert abs(message.publish_time / 1e9 - time.time()) < 60 and message.log_time < message.publish_time
print(f"{len(rows)} ticks and {len(events)} events as MCAP")
EOF2
cp -r "$folder/rec" "$folder/broken"
"$venv/bin/python" "$folder/read.py" "$folder" "$convert" || fail "others read something else"
exit $failed
