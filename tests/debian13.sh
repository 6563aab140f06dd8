#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# tests/debian13.sh DIR: the whole test suite with FreeCAD 1.0, in a Debian 13 of its own.
#
# Builds a Debian 13 (trixie) in the folder DIR, from the mirror and with the settings of this machine's apt, and runs
# ./ffds test there on a clone of this checkout. Run again, it takes the system that is there and a new clone. The types
# are left out there: numpy 2 describes its arrays in another way than numpy 1, for which they are written.
# Needs root, debootstrap and about 4 GB; DIR can be deleted afterwards.
set -eu

root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
if [ $# -ne 1 ]; then
    echo "usage: tests/debian13.sh DIR" >&2
    exit 2
fi
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
    echo "debian13.sh: run it as root, with debootstrap installed (apt-get install debootstrap)" >&2
    exit 2
fi
mkdir -p "$1"
system=$(cd -- "$1" && pwd)

if [ ! -e "$system/etc/apt/apt.conf.d/90host" ]; then
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Component: main' |
             head -n 1)
    if [ -z "$mirror" ]; then
        echo "debian13.sh: apt knows no Debian mirror: run apt-get update first" >&2
        exit 2
    fi
    debootstrap --variant=minbase trixie "$system" "$mirror"
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
if [ -d "$root/../shared" ]; then
    bind "$root/../shared" srv/shared
    mount -o remount,ro,bind "$system/srv/shared"
fi

rm -rf "$system/srv/ffds"
git clone -q "$root" "$system/srv/ffds"
chroot "$system" env HOME=/root DEBIAN_FRONTEND=noninteractive sh -c '
    apt-get -qq update &&
    apt-get -qq -y --no-install-recommends install git ca-certificates &&
    git config --global --add safe.directory /srv/ffds &&
    /srv/ffds/ffds test'
