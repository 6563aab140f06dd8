#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# ./ffds test: install what the tests need and run them all: lint, types, plain Python, freecadcmd, FreeCAD's GUI.
# Arguments go to pytest. Skipped tests are listed with their reasons. Fails if anything fails.
set -eu

root=$(dirname -- "$(readlink -f -- "$0")")/../..
root=$(cd -- "$root" && pwd)
. "$root/resources/scripts/packages.sh"
cd "$root"

# shellcheck disable=SC2086 # the lists are meant to be split
install_packages $run_packages $test_packages
install_if_there "$wished_package"
install_if_there "$wished_test_package"
install_packages "$(qt_test_package)"

python=/usr/bin/python3
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
mkdir "$home/Mod"
ln -s "$root" "$home/Mod/FFDS"
cp tests/gui/user.cfg "$home/user.cfg"
FREECAD_USER_HOME=$home
PYTHONDONTWRITEBYTECODE=1
QTWEBENGINE_DISABLE_SANDBOX=1
export FREECAD_USER_HOME PYTHONDONTWRITEBYTECODE QTWEBENGINE_DISABLE_SANDBOX
failed=""

step() {
    name=$1
    shift
    echo
    echo "== $name"
    if "$@"; then :; else
        echo "== $name: FAILED (exit code $?)"
        failed="$failed, $name"
    fi
}

# Debian's flake8 alone, whatever else lies on the path: the rules (.flake8) are the same on every machine.
step "lint (flake8)" "$python" -I -m flake8 .
if "$python" -c "import sys, numpy; sys.exit(int(numpy.__version__.split('.')[0]) > 1)"; then
    step "types (mypy)" "$python" -I -m mypy --no-error-summary --cache-dir "$home/mypy"
else
    echo "== types: left out, numpy 2 describes its arrays in another way than numpy 1"
fi
step "tests in plain Python" "$python" -m pytest -q --ignore tests/gui "$@"
kernels=$("$python" tests/other_kernels.py)
if [ -n "$kernels" ]; then
    step "numeric and B-rep tests once more, with OpenBLAS's kernels for $kernels" \
        env OPENBLAS_CORETYPE="$kernels" "$python" -m pytest -q tests/registration tests/brep
else
    echo "== other kernels: left out, this processor or its BLAS has no others"
fi
step "tests in freecadcmd" freecadcmd -c \
    "import sys, pytest; sys.exit(pytest.main(['-q', 'tests/api', 'tests/brep', 'tests/objects', 'tests/report', 'tests/scan']))"
step "tests in FreeCAD's GUI" timeout 1200 xvfb-run -a -s "-screen 0 1600x1000x24" freecad tests/gui/run_in_freecad.py

echo
if [ -n "$failed" ]; then
    echo "FAILED: ${failed#, }"
    exit 1
fi
echo "All passed. The skipped tests and their reasons are listed above."
