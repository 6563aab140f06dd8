#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# ./ffds setup: install what is needed, make FreeCAD know the workbench, and run the example. Harmless to run again.
set -eu

root=$(dirname -- "$(readlink -f -- "$0")")/../..
root=$(cd -- "$root" && pwd)
. "$root/resources/scripts/packages.sh"

# shellcheck disable=SC2086 # the list is meant to be split
install_packages $run_packages
install_if_there "$wished_package"

mods=${XDG_DATA_HOME:-$HOME/.local/share}/FreeCAD/Mod
link=$mods/FFDS
if [ -e "$link" ] && [ ! -L "$link" ]; then
    echo "ffds: $link is a folder of its own; move it away and run setup again" >&2
    exit 2
fi
mkdir -p "$mods"
ln -sfn "$root" "$link"
echo "FreeCAD finds the workbench FFDS at $link"
echo
"$root/ffds" demo --out "$root/out/demo"
