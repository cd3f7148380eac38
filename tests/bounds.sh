#!/bin/sh
# ethd-check as its users see it: what it prints is a configuration again; bounds, and what to change.
set -eu
. tests/begin.sh
check=$BUILD/bin/ethd-check
silent() { if grep -q -e "$2" "$1"; then cat "$1"; fail "it says '$2'"; fi; }

# The setup's part is a configuration that gives the same setup.
setup() { sed '/^drivers  /,$d' "$1" | grep -v '^; .* is valid$'; }
cp "$BUILD"/share/ethd/n.* "$BUILD/share/ethd/wall.scene" "$folder/"
"$check" "$folder/n.ini" >"$folder/a"
setup "$folder/a" >"$folder/again.ini"
"$check" "$folder/again.ini" >"$folder/b"
setup "$folder/b" | cmp - "$folder/again.ini" || fail "the setup isn't what it was read from"

# Also of what the shipped ones leave out.
{ printf '[arm]\nmechanism = serial\nlink1 = 0.3\n[limits]\nworkspace = 0.1 0.4 -1 1\ntorque = 1.5\n[finger_fit]\nlag ='
  seq -f ' %g' 0.001 0.0005 0.0085 | tr -d '\n'; } >"$folder/all.ini"
"$check" "$folder/all.ini" >"$folder/a2"
says "$folder/a2" '^lag  *= 0.001 0.0015 .* 0.008 0.0085 ;'
says "$folder/a2" '^workspace  *= 0.1 0.4 -1 1 ;'
setup "$folder/a2" >"$folder/again2.ini"
"$check" "$folder/again2.ini" >"$folder/b2"
setup "$folder/b2" | cmp - "$folder/again2.ini" || fail "the setup isn't what it was read from"

# Each bound by the name of its formula, the device's figures from the plant.
for words in 'spectral radius' 'Colgate' 'Abbott and Okamura' 'rest at touch' 'saturated braking' 'highest speed' \
  'v_th' 'rehearsed' 'no bound: this process' 'force 5.357 N' 'delay 0.071 ms' '^0 bounds exceeded'; do
  says "$folder/a" "$words"
done

# Plants n and b by hand: v* = sqrt(2 a gap) = 0.678, 0.543; K_e T/2 + B_e = 46.25.
says "$folder/a" '0.678 without lag'
says "$folder/a" '46.25 Ns/m'
cp "$BUILD"/share/ethd/b.* "$folder/"
"$check" "$folder/b.ini" >"$folder/b.out"
says "$folder/b.out" '0.543 without lag'

# A gain that is too large is named, with what to change; after that change none is named.
printf '[device]\nplant = n\n[transition]\nb_d = 1000\n' >"$folder/bad.ini"
"$check" "$folder/bad.ini" >"$folder/bad"
says "$folder/bad" '^2 bounds exceeded'
says "$folder/bad" 'transition.b_d  *1000 .*EXCEEDED'
most=$(sed -n 's/.*transition.b_d at most \([0-9.]*\).*/\1/p' "$folder/bad" | head -n 1)
[ -n "$most" ] || fail "it doesn't say what to change"
printf '[device]\nplant = n\n[transition]\nb_d = %s\n' "$(awk -v m="$most" 'BEGIN { print 0.999 * m }')" >"$folder/good.ini"
"$check" "$folder/good.ini" >"$folder/good"
says "$folder/good" '^0 bounds exceeded'

# What friction does for an unstable loop: with ideal encoders nothing sets it swinging.
cp "$BUILD"/share/ethd/p.* "$folder/"
"$check" "$folder/p.ini" >"$folder/p.out"
says "$folder/p.out" '^4 bounds exceeded'
says "$folder/p.out" 'stops swings slower than 7.7 mm/s at the motors.*273 mm/s: the ring chatters'
sed 's/^count  *=.*/count = 0/' "$folder/p.plant" >"$folder/ideal.plant"
sed 's/^plant = p/plant = ideal/' "$folder/p.ini" >"$folder/ideal.ini"
"$check" "$folder/ideal.ini" >"$folder/ideal.out"
says "$folder/ideal.out" 'one encoder count makes 0 mm/s: the ring is quiet until it is pushed'

# A spring is stable by friction alone; a delay may be a fraction of a tick; options win over the plant.
printf '[device]\nplant = n\n[contact]\nlaw = spring\n' >"$folder/spring.ini"
"$check" --delay 0 "$folder/spring.ini" >"$folder/out"
says "$folder/out" '1.25 Ns/m'
says "$folder/out" '^0 bounds exceeded'
"$check" --delay 0.5 --viscous 2.4 "$folder/spring.ini" >"$folder/out"
says "$folder/out" '2.5 Ns/m.*2.4: EXCEEDED'
"$check" --force-limit 50 --friction 0 --latency 0 "$folder/n.ini" >"$folder/out"
says "$folder/out" 'force 50 N'
silent "$folder/out" 'tracking.k_t, finger_filter.compensation = stamp'

# A plugin's law has gains that nobody knows: then the last word isn't "0 bounds exceeded".
silent "$folder/a" 'not judged'
printf '[plugins]\nfile = %s\n[transition]\nlaw = brake-ahead\n' "$BUILD/tests/plugins/mylaw.so" >"$folder/foreign.ini"
"$check" "$folder/foreign.ini" >"$folder/out"
says "$folder/out" '^not judged: braking, because the law brake-ahead doesn.t name its gains'
tail -n 1 "$folder/out" | grep -q '^not judged' || fail "it isn't the last word"

# One that names its gains is judged, whatever they are called: here by the bound of the paper's own braking.
sed 's/\.step = step};/.step = step, .gains = \&(const ethd_gains){NULL, "brake"}};/' apps/examples/law.c >"$folder/own.c"
$CC -shared -fPIC -Iinclude "$folder/own.c" -o "$folder/own.so" || fail "a law with gains doesn't compile"
for law in own.so:mine:brake none:offset:b_d; do
  key=${law##*:} name=${law#*:} file=${law%%:*}
  { [ $file = none ] || printf '[plugins]\nfile = %s\n' $file; printf '[transition]\nlaw = %s\n%s = 300\n[device]\nplant = n\n' "${name%:*}" $key; } >"$folder/own.ini"
  "$check" "$folder/own.ini" >"$folder/$key.out"
  silent "$folder/$key.out" 'not judged'
  sed -n "s/transition\.$key */gain /p" "$folder/$key.out" | grep 'gain.*300 .*EXCEEDED' >"$folder/$key.rows"
done
[ -s "$folder/brake.rows" ] && cmp -s "$folder/brake.rows" "$folder/b_d.rows" || fail "by another name: $(cat "$folder/brake.rows" "$folder/b_d.rows")"

# A torque limit of the configuration narrows the device's.
printf '[limits]\ntorque = 0.5\n' >"$folder/narrow.ini"
"$check" "$folder/narrow.ini" >"$folder/out"
says "$folder/out" 'force 2 N'

for option in '--delay 21' '--delay -1' '--counts 0' '--friction x' '--viscous nan' '--latency 2' '--force-limit inf'; do
  refuse 2 . "$check" $option "$folder/n.ini"
done
exit $failed
