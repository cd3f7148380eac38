#!/bin/sh
# What identification, tuning and calibration write: no input is written over, and no output by another one. What happens
# when standard output is closed, and when a disk is full.
. tests/begin.sh
bin=$BUILD/bin
cd "$folder" || exit 1


# ---- an output that is an input, or another output ----
"$bin/ethd-identify" --excite --virtual --duration 6.158 --record sines >said || fail "a recording: exit $?"
cp "$bin/../share/ethd/n.plant" mine.plant
find . -type f ! -name out ! -name err ! -name before -exec md5sum {} + | sort >before
identify="$bin/ethd-identify sines --base mine.plant"
refuse 2 'out: mine.plant is the file of --base, which is only read' $identify --out mine.plant
refuse 2 'csv: ./mine.plant is the file of --base' $identify --csv ./mine.plant
for file in tick.npy config.ini events.csv; do
  refuse 2 "out: sines/$file belongs to the recording sines, which is only read" $identify --out "sines/$file"
done
refuse 2 'plot: sines/events.csv belongs to the recording' $identify --plot sines/events.png
refuse 2 'csv: ./fit is the file of --out, too' $identify --out fit --csv ./fit
ln -s events.csv sines/other
refuse 2 'csv: sines/other belongs to the recording' $identify --csv sines/other
rm sines/other
cp "$bin/../share/ethd/n.ini" "$bin/../share/ethd/wall.scene" .
md5sum ./n.ini ./wall.scene >>before
tune="$bin/ethd-tune --plant mine.plant --config n.ini --points 8 --taps 20"
refuse 2 'plot: found "mine.plant", a file .png is needed' $tune --csv x.csv --plot mine.plant
refuse 2 'csv: ./x is the file of --out, too' $tune --out x --csv ./x
refuse 2 'plot: x.png is the file of --csv, too' $tune --csv x.png --plot x.png
refuse 2 'plot: ring.png is the file of --csv, too' "$bin/ethd-calibrate" --self-test --csv ring.png --plot ring.png
md5sum --quiet -c before || fail "an input was changed"
# devices take what several write
"$bin/ethd-identify" sines --base mine.plant --out /dev/null --csv /dev/null >said 2>err || fail "/dev/null twice: $(cat err)"

# ---- in a mount namespace: closed standard output; a disk that fills up while events are written ----
if unshare -rm true 2>/dev/null; then
  mkdir disk
  # a copy of /dev, so that nothing can replace the system's
  cat >"$folder/closed.sh" <<'END'
mount -t tmpfs tmpfs disk && mkdir disk/dev && cd disk || exit 9
ln -s /proc/self/fd dev/fd && ln -s /proc/self/fd/1 dev/stdout && touch dev/null && mount --bind /dev/null dev/null || exit 9
mount --rbind dev /dev || exit 9
tap="$1/ethd-tap --taps 1 --transition offset --speed low"
for name in stdout fd/1 ../dev/stdout; do
  $tap --csv /dev/$name >&- 2>err
  [ $? = 2 ] && [ "$(wc -l <err)" = 1 ] && grep -q "/dev/$name: " err || { echo "$name: $(cat err)"; exit 1; }
done
[ -L /dev/stdout ] && [ -z "$(ls /dev | grep new)" ] || { ls -l /dev; exit 1; }
$tap --csv /dev/stdout >both 2>err && [ "$(grep -c '^0,offset' both)" = 1 ] && grep -q 'm/s' both || { echo "written through: $(cat err both)"; exit 1; }
# what is printed goes into no file
$tap --csv taps.csv --record r >&- 2>err
[ $? = 1 ] && grep -q 'standard output: ' err && [ "$(wc -l <taps.csv)" = 2 ] || { echo "closed: $(cat err taps.csv)"; exit 1; }
"$1/ethd-replay" --verify r >said || { cat said; exit 1; }
END
  unshare -rm sh "$folder/closed.sh" "$bin" >said 2>&1 || fail "standard output is closed: $(cat said)"
  cat >"$folder/fill.sh" <<'END'
mount -t tmpfs -o size=1m tmpfs disk && cd disk || exit 9
whole=0
for count in $(seq 128 2 172); do
  { yes 'set contact.k_e 2000' | head -n "$count"; echo 'wait 9'; } | "$1/ethd-run" --virtual --duration 9 --record r >said 2>err
  [ "$(grep -c ',fault,the recorder lost rows: No space left on device$' r/events.csv)" = 1 ] && whole=$((whole + 1)) ||
    { echo "after $count settings, $(wc -c <r/events.csv) bytes:"; tail -n 2 r/events.csv; }
  rm -r r
done
[ $whole = 23 ]
END
  unshare -rm sh "$folder/fill.sh" "$bin" >said 2>&1 || fail "a full disk has no room for its event: $(cat said)"
else
  echo 'no mounts of its own: a recording on a full disk is left out'
fi
exit $failed
