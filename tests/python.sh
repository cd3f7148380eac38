#!/bin/sh
# apps/python, installed by pip: with the build and the distribution's numpy, then with an installed tree and PyPI's numpy
# (skipped where PyPI can't be reached). The source tree stays as it is; types are checked where mypy can be had.
set -u
[ -z "${SAN:-}" ] || { echo "SKIP: Python isn't made for sanitizers"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3=$(sh .ci/setup python) || { echo "FAILED: no python3 with numpy, which .ci/setup check brings"; exit 1; }
# pip makes its package from a copy; include lies where a tree has it
mkdir -p "$work/tree/apps" "$work/data" && cp -r apps/python "$work/tree/apps" && cp -r include "$work/tree"
installed() { # VENV PACKAGES...
  venv=$1
  shift
  "$venv/bin/pip" -q --disable-pip-version-check install "$@" >"$work/pip" 2>&1
}
tried() { # VENV NAME
  mkdir "$work/data/$2"
  (cd "$work" && "$1/bin/python" "$OLDPWD/tests/python_package.py" "$BUILD" "$work/data/$2") 2>&1
}

"$python3" -m venv --system-site-packages "$work/own" || exit 1
ETHD_BUILD=$BUILD installed "$work/own" --no-build-isolation --no-deps "$work/tree/apps/python" ||
  { cat "$work/pip"; echo "FAILED: pip install, without a network"; exit 1; }
tried "$work/own" own || exit 1
[ -z "$(cd "$work/tree/apps/python" && find . -name build -o -name '*.egg-info')" ] || { echo "FAILED: pip leaves files in the source tree"; exit 1; }

$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$work/usr" install-files >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
# PyPI's packages are fetched once for a build
pypi=$BUILD/peers/numpy
mkdir -p "$BUILD/peers"
"$pypi/bin/python" -c 'import cffi, mypy, numpy, setuptools, wheel' 2>/dev/null ||
  { rm -rf "$pypi" && "$python3" -m venv "$pypi" && installed "$pypi" numpy cffi setuptools wheel mypy==1.18.2; } ||
  { tail -n 1 "$work/pip"; echo "SKIP: PyPI can't be reached for its numpy"; exit 77; }
mv "$work/tree/include" "$work/tree/not_include"
PKG_CONFIG_PATH=$work/usr/lib/pkgconfig installed "$pypi" --no-build-isolation --target "$work/site" --no-deps "$work/tree/apps/python" ||
  { cat "$work/pip"; echo "FAILED: pip install, with an installed libethd"; exit 1; }
export PYTHONPATH="$work/site"
tried "$pypi" pypi || exit 1
(cd "$work/tree/apps/python" && "$pypi/bin/mypy" --strict --ignore-missing-imports --disable-error-code=type-arg ethd) >"$work/mypy" 2>&1 ||
  { cut -c1-200 "$work/mypy"; echo "FAILED: types"; exit 1; }
tail -n 1 "$work/mypy"
# Neither a library nor a build: one sentence.
rm -rf "$work/usr"
PKG_CONFIG_PATH=$work/usr installed "$pypi" --no-build-isolation --target "$work/none" --no-deps "$work/tree/apps/python" && { echo "FAILED: made of nothing"; exit 1; }
grep -q "there is no libethd-drivers.a; run make, or install libethd" "$work/pip" || { cat "$work/pip"; echo "FAILED: no sentence"; exit 1; }
