#!/bin/sh
# Configurations, solids and recordings of the front in space, as the programs take them.
. tests/begin.sh
bin=$BUILD/bin ini=apps/config/space.ini

# ---- ethd-check: the setup, and how far before a wall the device reacts ----
"$bin/ethd-check" $ini >"$folder/page" 2>&1 || fail "ethd-check: $(cat "$folder/page")"
page() { says "$folder/page" "$@"; }
page '^command       = velocity'
page '^effector      = plate'
page '^file          = room.solids ; 4 objects, 1 material$'
# t_d = 8 + 1 ms, a = 0.8 * 10 m/s^2, gap = 60 mm: 0.4 t_d + 0.16 / (2 a) = 13.6 mm; v* = 8 (sqrt(t_d^2 + 0.12 / 8) - t_d)
page 't_d  *9 ms: delay of \[ability\], and the period 1 ms'
page 'at 0.2 m/s  *4.300 mm of the gap of 60.000 mm: the effector stands when the finger arrives'
page 'at 0.4 m/s  *13.600 mm of the gap'
page 'highest speed  *0.910 m/s'
page 'wait  *the plate stands at the wall while the finger is within 160 mm of it$'
page 'range  *0.4 m before the wall, enough to stop from 2.459 m/s$'
page '^0 bounds exceeded$'
# the page is a configuration that gives the same page
cp apps/config/room.solids "$folder"
"$bin/ethd-check" $ini | sed '/^reaction/,$d' >"$folder/again.ini"
"$bin/ethd-check" "$folder/again.ini" | sed 1d >"$folder/again" && sed 1d "$folder/page" | cmp - "$folder/again" || fail "its page isn't its configuration"
# an arm says itself what it can do: the delay of its table and servo, 8 + 2 / omega, and its joints
"$bin/ethd-check" apps/config/ur5e.ini >"$folder/page" || fail "an arm: $(cat "$folder/page")"
page '^drivers  *arm: read, not touched'
page "nearest end of a joint's travel  *1.242 rad\$"
page 't_d  *23.33 ms: delay of the device, and the period 2 ms'
page "a  *9.6 m/s^2: the law's share of the least that"
sed 's/^radius .*/radius = 0.0185/; s/^delay.*/delay = 0.03/; s/^speed.*/speed = 5/' $ini >"$folder/short.ini"
"$bin/ethd-check" "$folder/short.ini" >"$folder/page" || fail "a short gap: $(cat "$folder/page")"
page 'at 0.4 m/s  *22.400 mm of the gap of 10.500 mm: the finger arrives before the effector stands'
page 'space.speed is higher'
page '^2 bounds exceeded$'

refuse 2 'space.ini: \[space\] is there; the figures are for the plane' "$bin/ethd-check" --delay 1 $ini
what='space.ini: \[space\] is for a device in space, and this program works in the plane'
refuse 2 'space.ini: device.driver: sim has no part in a device in space' "$bin/ethd-run" --virtual --duration 1 --config $ini
refuse 2 "$what" "$bin/ethd-tap" --config $ini
refuse 2 "$what" "$bin/ethd-tune" --config $ini
refuse 2 "$what" "$bin/ethd-replay" --config $ini --in $ini --out "$folder/x.csv"
refuse 2 "$what" "$bin/ethd-scene" info apps/config/room.scene --config $ini

# ---- ethd-scene ----
"$bin/ethd-scene" info apps/config/room.solids >"$folder/page" || fail "ethd-scene: $(cat "$folder/page")"
page 'room.solids: 4 solids$'
page 'extent:  *x 0.26 to 0.679282032 m, y -0.34 to 0.28 m, z 0 to 0.3 m, without half-spaces'
refuse 2 'holds solids; --plot and --config are for scenes of the plane' "$bin/ethd-scene" info apps/config/room.solids --plot "$folder/x.png"
printf 'sphere 0 0 0 1\nball 0 0 0 1\n' >"$folder/bad.solids"
refuse 2 'bad.solids:2: ball: an unknown name; halfspace, sphere, capsule, box, material are allowed' "$bin/ethd-scene" info "$folder/bad.solids"
printf 'x_m,y_m\n0,0\n' >"$folder/points.csv"
refuse 2 'room.solids: holds solids of space' "$bin/ethd-scene" query --scene apps/config/room.solids --in "$folder/points.csv" --out "$folder/x.csv"

# ---- recordings ----
"$BUILD/tests/space_tap" $ini "$folder/rec" || fail "no recording"
"$bin/ethd-replay" --verify "$folder/rec" >"$folder/page" 2>&1 || fail "verify: $(cat "$folder/page")"
page 'rec: 4000 ticks, equal to the bit'
sed 's/set,transition.effort 0.7/set,transition.effort 0.71/' "$folder/rec/events.csv" >"$folder/changed" && cp -r "$folder/rec" "$folder/other" && cp "$folder/changed" "$folder/other/events.csv"
"$bin/ethd-replay" --verify "$folder/other" >"$folder/page" 2>&1 && fail "another gain verifies"
page 'other: tick 2[0-9]*: .*: recorded '
refuse 2 "config.ini: \[space\] is for a device in space" "$bin/ethd-identify" "$folder/rec" --out "$folder/x.plant"

python3=$(sh .ci/setup python) || { echo "SKIP: no python3 with numpy"; exit 77; }
"$bin/ethd-convert" "$folder/rec" "$folder/rec.csv" >"$folder/page" 2>&1 || fail "convert: $(cat "$folder/page")"
"$python3" - "$folder" <<'END' || failed=1
import csv, sys
import numpy as np
rows = np.load(sys.argv[1] + "/rec/tick.npy")
with open(sys.argv[1] + "/rec.csv") as file:
    found = list(csv.DictReader(file))
assert len(found) == len(rows) == 4000
for field, names in dict(x="x_m y_m z_m", command="command_x command_y command_z", d_re="d_re_m", near="near", near_id="near1_id near2_id",
                         near_v="near1_vx_mps near1_vy_mps", near_point="near1_x_m near1_y_m near1_z_m near2_x_m", fe="fex_N fey_N fez_N").items():
    values = rows[field].reshape(len(rows), -1)
    for i, name in enumerate(names.split()):
        assert np.array_equal(values[:, i], np.array([float(row[name] or "nan") for row in found]), equal_nan=True), name
assert {row["reading_x_m"] for row in found} == {row["able_delay_s"] for row in found} == {""}
END
exit $failed
