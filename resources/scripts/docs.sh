#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# resources/scripts/docs.sh [DIR]: the documentation as HTML, DIR/index.html (default: out/docs). A warning is an error.
# Needs Debian's python3-sphinx and python3-myst-parser.
set -eu

root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
out=${1-$root/out/docs}
if ! /usr/bin/python3 -c "import sphinx, myst_parser" 2>/dev/null; then
    echo "docs.sh: Sphinx is missing: apt-get install python3-sphinx python3-myst-parser" >&2
    exit 2
fi
/usr/bin/python3 -m sphinx -q -W --keep-going -b html -d "$out/.doctrees" "$root/resources/docs" "$out"
echo "$out/index.html"
