#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# tests/systems.sh bookworm|trixie|forky [DIR]: ./ffds setup and the whole suite in a bare Debian of its own.
#
# bookworm (12) has FreeCAD 0.20 with Qt 5, trixie (13) 1.0 with Qt 5, forky 1.1 with Qt 6. Builds that Debian in
# DIR/NAME (default: /var/tmp/ffds-systems) with the settings of this machine's apt, from the mirror that apt uses or
# $FFDS_MIRROR, and runs ./ffds setup and ./ffds test there on a clone of this checkout's last commit. Run again, it
# takes the system that is there and a new clone. ../shared comes along where it is. The last line says how it went.
# Needs root, debootstrap and about 4 GB each; DIR can be deleted afterwards.
set -eu

root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
refuse() {
    echo "systems.sh: $1" >&2
    exit 2
}
case "$#:${1-}" in
[12]:bookworm | [12]:trixie | [12]:forky) name=$1 ;;
*) refuse "name bookworm, trixie or forky, and the folder for it if you like" ;;
esac
[ "$(id -u)" -eq 0 ] && command -v debootstrap >/dev/null ||
    refuse "run it as root, with debootstrap installed (apt-get install debootstrap)"
mkdir -p "${2-/var/tmp/ffds-systems}/$name"
system=$(cd -- "${2-/var/tmp/ffds-systems}/$name" && pwd)

if [ ! -e "$system/etc/apt/apt.conf.d/90host" ]; then
    mirror=${FFDS_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' \
                            'Component: main' | head -n 1)}
    [ -n "$mirror" ] || refuse "apt knows no Debian mirror: run apt-get update, or name one in FFDS_MIRROR"
    # The script of unstable builds all three; debootstrap may be older than the Debian that it builds.
    debootstrap --variant=minbase "$name" "$system" "$mirror" /usr/share/debootstrap/scripts/sid
    apt-config dump | grep '^Acquire' > "$system/etc/apt/apt.conf.d/90host"
fi

mounted=""
clean_up() {
    for folder in $mounted; do umount "$folder"; done
}
trap clean_up EXIT
bind() {
    mkdir -p "$system/$2"
    mount --bind "$1" "$system/$2"
    mounted="$system/$2 $mounted"
}
bind /proc proc
bind /dev/shm dev/shm
bind /dev/pts dev/pts
if [ -d "$root/../shared" ]; then
    bind "$root/../shared" srv/shared
    mount -o remount,ro,bind "$system/srv/shared"
fi

rm -rf "$system/srv/ffds"
git clone -q "$root" "$system/srv/ffds"
inside() {
    chroot "$system" env -u DISPLAY HOME=/root DEBIAN_FRONTEND=noninteractive \
        OPENBLAS_NUM_THREADS="${OPENBLAS_NUM_THREADS-}" sh -c "$1"
}
inside '
    apt-get -qq update &&
    apt-get -qq -y --no-install-recommends install git ca-certificates &&
    git config --global --replace-all safe.directory /srv/ffds &&
    /srv/ffds/ffds setup && /srv/ffds/ffds test' && code=0 || code=$?
echo "$name, FreeCAD $(inside "dpkg-query -W -f '\${Version}' freecad"), of $(git -C "$root" rev-parse --short HEAD): exit code $code"
exit "$code"
