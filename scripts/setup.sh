#!/usr/bin/env bash
# Installs the Debian packages that RAPLAS is built and tested with. Idempotent.
#
# usage: scripts/setup.sh [--check]
#   --check  only says what is missing; exit 1 if anything is
#
# Needs Debian 12, the network, and root or sudo.
set -euo pipefail

packages=(
  # build
  build-essential cmake ninja-build ccache git python3
  # VHDL and Verilog: simulation, export, netlists
  ghdl ghdl-llvm verilator yosys
  # proofs
  berkeley-abc gappa
  # libraries of the host and the tests
  libassimp-dev libcli11-dev libfmt-dev libglm-dev libpng-dev nlohmann-json3-dev
  libgtest-dev libgmock-dev libmpfr-dev libgmp-dev
  # benchmarks: another ray tracer, plots, picture metrics
  libembree-dev python3-matplotlib python3-pil python3-skimage
  # linters
  clang-format clang-tidy
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done

if [ ${#missing[@]} -eq 0 ]; then
  [ "${1:-}" = --check ] || echo "setup: all ${#packages[@]} packages are installed"
  exit 0
fi
if [ "${1:-}" = --check ]; then
  echo "setup: missing: ${missing[*]}" >&2
  exit 1
fi

run=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "setup: not root and no sudo: as root, install ${missing[*]}" >&2
    exit 1
  }
  run=(sudo)
fi
command -v apt-get >/dev/null || {
  echo "setup: no apt-get: this script is for Debian 12; install ${missing[*]} by your own means" >&2
  exit 1
}

echo "setup: installing ${missing[*]}"
"${run[@]}" apt-get update -qq || {
  echo "setup: apt-get update failed: is there a network?" >&2
  exit 1
}
"${run[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null || {
  echo "setup: apt-get install failed: is there a network? Wanted: ${missing[*]}" >&2
  exit 1
}
echo "setup: done"
