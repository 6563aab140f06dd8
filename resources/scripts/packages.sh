# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by setup.sh and test.sh: which Debian packages are needed, and how they are installed.

run_packages="freecad freecad-python3 python3-numpy python3-scipy python3-matplotlib python3-open3d python3-distributed python3-fastapi python3-uvicorn"
test_packages="python3-httpx python3-pytest python3-hypothesis python3-jsonschema python3-sphinx python3-myst-parser mypy flake8 xvfb xauth"
# Done without where a system has them not: the library with which reports turn the part, and a browser to try that.
wished_package="libjs-three"
wished_test_package="chromium"

# The package that tests windows, of the Qt that FreeCAD is built with: 5 in Debian 12 and 13, 6 later.
qt_test_package() {
    if dpkg-query -W python3-pyside6.qtcore >/dev/null 2>&1; then
        echo python3-pyside6.qttest
    else
        echo python3-pyside2.qttest
    fi
}

# Install those of the named packages that are missing; nothing is touched if none is.
install_packages() {
    missing=""
    for package in "$@"; do
        if ! dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q "install ok installed"; then
            missing="$missing $package"
        fi
    done
    [ -n "$missing" ] || return 0
    if [ "$(id -u)" -eq 0 ]; then
        as_root="env"
    elif command -v sudo >/dev/null; then
        as_root="sudo env"
    else
        echo "ffds: these packages are missing and neither root nor sudo is at hand:$missing" >&2
        return 2
    fi
    echo "Installing$missing"
    $as_root DEBIAN_FRONTEND=noninteractive apt-get -qq update
    # shellcheck disable=SC2086 # the list is meant to be split
    $as_root DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install $missing
}

# Install a package that can be done without, where this system knows it.
install_if_there() {
    if dpkg-query -W "$1" >/dev/null 2>&1 || apt-cache show "$1" >/dev/null 2>&1; then
        install_packages "$1" || echo "ffds: left out, as it could not be installed: $1" >&2
    else
        echo "ffds: left out, as this system does not know it: $1" >&2
    fi
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    echo "ffds: setup and test need Debian's apt-get; elsewhere install FreeCAD, numpy, scipy, matplotlib and open3d" >&2
    exit 2
fi
