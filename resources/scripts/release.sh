#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# resources/scripts/release.sh DIR [REPOSITORY]: the zip that FreeCAD's Addon Manager installs, DIR/FFDS-VERSION.zip.
#
# Checks first that version, date and changelog agree and that all is committed, then runs the suite on the systems that
# $FFDS_SYSTEMS names, unless told all three that are supported: no zip is built where one fails. The repository's address
# is known to who publishes, not to the sources: named here, it goes into the zip's package.xml, with those of its readme
# and issues.
set -eu

root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
if [ $# -lt 1 ] || [ $# -gt 2 ]; then
    echo "usage: resources/scripts/release.sh DIR [https://…/REPOSITORY]" >&2
    exit 2
fi
mkdir -p "$1"
out=$(cd -- "$1" && pwd)
repository=${2-}
cd "$root"

refuse() {
    echo "release.sh: $1" >&2
    exit 3
}

version=$(sed -n 's/^__version__ = "\(.*\)"$/\1/p' ffds_workbench/__init__.py)
date=$(sed -n 's/^ *<date>\(.*\)<.*/\1/p' package.xml)
grep -q "<version>$version</version>" package.xml || refuse "package.xml is not of version $version"
[ "$(sed -n 's/^## //p' CHANGELOG.md | head -n 1)" = "$version" ] || refuse "CHANGELOG.md does not begin with $version"
[ -z "$(git status --porcelain)" ] || refuse "there are changes that are not committed"
[ "$(git log -1 --format=%cs)" = "$date" ] || refuse "package.xml's date is $date, the last commit's another: set it"
[ -z "$(git ls-files -s | grep '^120000' || true)" ] || refuse "there are symbolic links, which zips do not keep"
case "$repository" in
"" | https://*) ;;
*) refuse "the repository's address begins with https://" ;;
esac

for system in ${FFDS_SYSTEMS-bookworm trixie forky}; do
    sh tests/systems.sh "$system" || refuse "the suite fails on $system"
done

GIT_INDEX_FILE=$(mktemp)
export GIT_INDEX_FILE
trap 'rm -f "$GIT_INDEX_FILE"' EXIT
git read-tree HEAD
if [ -n "$repository" ]; then
    address='\1<url type="repository" branch="main">'$repository'</url>\n\1<url type="bugtracker">'$repository'/issues</url>\n'
    address="$address"'\1<url type="readme">'$repository'/blob/main/README.md</url>'
    described=$(sed "s|^\( *\)<url type=\"readme\">.*|$address|" package.xml | git hash-object -w --stdin)
    git update-index --cacheinfo "100644,$described,package.xml"
fi
git archive --format=zip --output "$out/FFDS-$version.zip" "$(git write-tree)"
echo "$out/FFDS-$version.zip"
