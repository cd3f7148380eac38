#!/bin/sh
# The example mujoco_arm.c: an arm whose dynamics aren't ours, driven by velocities and by torques before an oblique wall, with a
# headset that is 30 ms late. Felt offset, speed of the plate at the touch, no touch before the wall; and its model, ur5e.xml, has the
# place and the Jacobian of ur5e.arm.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: MuJoCo isn't built for a sanitizer"; exit 77; }
venv=$(PYTHON=/usr/bin/python3 sh .ci/venv mujoco_python mujoco==3.3.7) || { echo "SKIP: MuJoCo from PyPI"; exit 77; }
site=$(cd "$venv"/lib/python3*/site-packages/mujoco && pwd)
$CC -std=gnu11 -O2 -Wall -Wextra -Werror -Iinclude -I"$site/include" -shared -fPIC apps/examples/mujoco_arm.c \
  "$site"/libmujoco.so.* -Wl,-rpath,"$site" -o "$folder/mujoco_arm.so" || { fail "mujoco_arm.c doesn't compile"; exit 1; }
cp apps/examples/ur5e.xml apps/config/ur5e.solids "$folder"

# ---- place, facing and Jacobian: tests/reference/arms.csv, with which tests/unit/test_linkage.c compares ours ----
"$venv/bin/python" - <<'END' || fail "ur5e.xml isn't ur5e.arm"
import mujoco, numpy as np
turn = np.zeros(4)
mujoco.mju_euler2Quat(turn, np.array([0.6, -0.5, 0.4]), "zyx")  # the base of the reference: arm_kinematics.py
text = open("apps/examples/ur5e.xml").read().replace(
    "<worldbody>", f'<worldbody><body pos="0.1 -0.2 0.3" quat="{" ".join(map(repr, turn.tolist()))}">')
model = mujoco.MjModel.from_xml_string(text.replace("</worldbody>", "</body></worldbody>"))
data, worst, count = mujoco.MjData(model), 0.0, 0
for line in open("tests/reference/arms.csv"):
    if not line.startswith("ur5e,"):
        continue
    values = np.array([float(v) for v in line.split(",")[2:]])
    data.qpos[:] = values[:6]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    moves, turns = np.zeros((3, 6)), np.zeros((3, 6))
    mujoco.mj_jacSite(model, data, moves, turns, 0)
    found = [*data.site_xpos[0], *data.site_xmat[0][[2, 5, 8]], *np.vstack([moves, turns]).T.ravel()]
    worst, count = max(worst, np.abs(found - values[6:]).max()), count + 1
print(f"{count} postures: place, facing and Jacobian within {worst:.1e}")
raise SystemExit(not (count == 5 and worst <= 1e-12))
END

# ---- reaches NAME MOST FAST LINES: five of them, each felt within MOST mm and with the plate at FAST mm/s at most ----
reaches() {
  cat >"$folder/$1.ini" <<END
[space]
effector = plate
radius = 0.068
finger_radius = 0.008
finger_radius_max = 0.010
turn_rate = 1
[scene]
file = ur5e.solids
[device]
driver = file:mujoco_arm.so, hand
mujoco_arm.model = ur5e.xml
$4
END
  "$BUILD/tests/reach" "$folder/$1.ini" >"$folder/$1" 2>&1
  sed "s/^/$1: /" "$folder/$1"
  awk -v most="$2" -v fast="$3" '/mm beyond the wall/ { n++; if ($6 ^ 2 > most ^ 2 || $12 ^ 2 > fast ^ 2) bad = 1 }
    END { exit !(n == 5 && NR == 5 && !bad) }' "$folder/$1" || fail "$1"
}
by_velocity='[space]
period = 0.002
speed = 1
acceleration = 12'
by_torque='[space]
command = force
speed = 3
force = 100
[tracking]
k = 400
b = 60
[contact]
k_e = 3000
b_e = 100
[transition]
law = predictive'
reaches velocity 0.1 5 "$by_velocity"
reaches late 0.1 5 "mujoco_arm.delay = 0.03
$by_velocity"
reaches torque 2.5 65 "mujoco_arm.delay = 0.002
$by_torque"

# ---- it keeps the contract of a device in space; only one that takes velocities is driven to its ends ----
for how in velocity torque; do
  sed -i 's/, hand$//' "$folder/$how.ini"
  [ $how = velocity ] && kept=7 || kept=6
  "$BUILD/bin/ethd-conform" --config "$folder/$how.ini" --virtual --move >"$folder/out" 2>&1
  [ "$(grep ' kept ' "$folder/out" | grep -vc '^calls')" = $kept ] || fail "$how: $(cat "$folder/out")"
done

# a model that isn't there, and one that doesn't suit
sed 's/<joint /<joint limited="false" /' apps/examples/ur5e.xml >"$folder/endless.xml"
for model in none.xml bare.xml endless.xml; do
  echo '<mujoco/>' >"$folder/bare.xml"
  printf '[space]\n[device]\ndriver = file:mujoco_arm.so\nmodel = %s\n[scene]\nfile = ur5e.solids\n' $model >"$folder/none.ini"
  "$BUILD/tests/reach" "$folder/none.ini" 2>"$folder/err" && fail "$model is taken"
  says "$folder/err" 'none.xml\|a site `plate`, a key, and 2 to 7 joints with a motor and a range'
done
exit $failed
