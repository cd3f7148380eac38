#!/bin/sh
# apps/python, installed by pip: with the build and the distribution's numpy, then from its sdist, with an installed tree and
# PyPI's numpy (skipped where PyPI can't be reached). The source tree stays as it is; types are checked, also those that a
# user sees.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: Python isn't made for sanitizers"; exit 77; }
python3=$(sh .ci/setup python) || { echo "FAILED: no python3 with numpy, which .ci/setup check brings"; exit 1; }
# pip makes its package from a copy; include lies where a tree has it
mkdir -p "$folder/tree/apps" "$folder/data" && cp -r apps/python "$folder/tree/apps" && cp -r include LICENSE "$folder/tree"
installed() { # VENV PACKAGES...
  venv=$1
  shift
  "$venv/bin/pip" -q --disable-pip-version-check install "$@" >"$folder/pip" 2>&1
}
tried() { # VENV NAME
  mkdir "$folder/data/$2"
  for part in package tables; do
    (cd "$folder" && "$1/bin/python" "$OLDPWD/tests/python_$part.py" "$BUILD" "$folder/data/$2") 2>&1 || return
  done
}

"$python3" -m venv --system-site-packages "$folder/own" || exit 1
ETHD_BUILD=$BUILD installed "$folder/own" --no-build-isolation --no-deps "$folder/tree/apps/python" ||
  { cat "$folder/pip"; echo "FAILED: pip install, without a network"; exit 1; }
tried "$folder/own" own || exit 1
[ -z "$(cd "$folder/tree/apps/python" && find . -name build -o -name '*.egg-info')" ] || { echo "FAILED: pip leaves files in the source tree"; exit 1; }

$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$folder/usr" install-files >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
sh .ci/venv unpinned numpy 2>/dev/null && { echo "FAILED: a package of PyPI without its version"; exit 1; }
pypi=$(sh .ci/venv numpy numpy==2.2.6 cffi==1.17.1 setuptools==80.9.0 wheel==0.45.1 build==1.3.0 mypy==1.18.2) ||
  { echo "SKIP: PyPI can't be reached for its numpy"; exit 77; }
mv "$folder/tree/include" "$folder/tree/not_include"
export PKG_CONFIG_PATH="$folder/usr/lib/pkgconfig"
# What is given on holds all that it takes to install it elsewhere, licence included.
"$pypi/bin/python" -m build --sdist --no-isolation --outdir "$folder/dist" "$folder/tree/apps/python" >"$folder/pip" 2>&1 ||
  { cat "$folder/pip"; echo "FAILED: no sdist"; exit 1; }
[ -z "$(cd "$folder/tree/apps/python" && find . -name build -o -name '*.egg-info')" ] || { echo "FAILED: an sdist leaves files in the source tree"; exit 1; }
installed "$pypi" --no-build-isolation --target "$folder/site" --no-deps "$folder"/dist/ethd-*.tar.gz ||
  { cat "$folder/pip"; echo "FAILED: pip install of the sdist, with an installed libethd"; exit 1; }
cmp LICENSE "$folder"/site/ethd-*.dist-info/licenses/LICENSE || { echo "FAILED: the licence isn't installed"; exit 1; }
unset PKG_CONFIG_PATH
export PYTHONPATH="$folder/site"
tried "$pypi" pypi || exit 1
(cd "$folder/tree/apps/python" && "$pypi/bin/mypy" --strict ethd ethd_programs) >"$folder/mypy" 2>&1 ||
  { cut -c1-200 "$folder/mypy"; echo "FAILED: types"; exit 1; }
tail -n 1 "$folder/mypy"
# A user's program: what is right passes, each line that is wrong is seen.
cat >"$folder/user.py" <<'END'
from typing import Any, Dict

import ethd
import numpy as np


@ethd.transition_law("mine", brake=(60, 0, 1000, "Ns/m"))
def mine(p: Dict[str, float], state: Any, contact: Any, out: Any) -> None:
    out.damping = p["brake"]


recording = ethd.read("taps")
taus = [step.tau for row, step in recording.replay()]
c = recording.controller()
c.post({"transition.law": mine, "contact.k_e": 500})
torque: float = float(c.step(np.zeros((), ethd.SENSE)).tau[0])
study = ethd.Study("study")
valid = study.taps[study.taps["valid"] == 1]
ticks = [len(trial.tick) for tap, trial in study.trials()]
END
(cd "$folder" && MYPYPATH=$folder/site "$pypi/bin/mypy" --strict user.py) >"$folder/mypy" 2>&1 ||
  { cut -c1-200 "$folder/mypy"; echo "FAILED: types as a user sees them"; exit 1; }
printf 'recording.tik\nc.step("a row")\nethd.Scene("").nearest([[0, 0]]).norm\nstudy.trial(1)\n' >>"$folder/user.py"
(cd "$folder" && MYPYPATH=$folder/site "$pypi/bin/mypy" --strict user.py) >"$folder/mypy" 2>&1
[ "$(grep -c '^user.py:.*error' "$folder/mypy")" = 4 ] || { cut -c1-200 "$folder/mypy"; echo "FAILED: wrong types pass"; exit 1; }
# Neither a library nor a build: one sentence.
rm -rf "$folder/usr"
PKG_CONFIG_PATH=$folder/usr installed "$pypi" --no-build-isolation --target "$folder/none" --no-deps "$folder/tree/apps/python" && { echo "FAILED: made of nothing"; exit 1; }
grep -q "there is no libethd-drivers.a; run make, or install libethd" "$folder/pip" || { cat "$folder/pip"; echo "FAILED: no sentence"; exit 1; }
