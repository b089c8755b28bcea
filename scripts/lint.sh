#!/usr/bin/env bash
# Formatters, linters and generated files; exit 1 at the first that complains.
#
# usage: scripts/lint.sh BUILD    BUILD: a folder with the host built, for its compile_commands.json
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:?usage: scripts/lint.sh BUILD}

mapfile -t cpp < <(git ls-files -- '*.cpp' '*.hpp' ':!:cmodel/include/raplas/constants.hpp')
# the bridge's backends are left out: their port tables exist only inside a bench's build
mapfile -t sources < <(git ls-files -- 'bench/*.cpp' 'host/src/*.cpp' 'tb/bridge/*.cpp' 'tb/trace/*.cpp' \
  ':!:tb/bridge/dut_*.cpp' ':!:*_test.cpp')
[ ${#cpp[@]} -gt 0 ] || { echo "lint: git lists no files here: lint works in a clone" >&2; exit 1; }
mapfile -t vhdl < <(git ls-files -- 'rtl/*.vhd' 'tb/*.vhd' ':!:tb/broken')

echo "lint: generated files"
scripts/constants.py --check
scripts/pipeline_svg.py --check

echo "lint: clang-format, ${#cpp[@]} files"
clang-format --dry-run --Werror "${cpp[@]}"

echo "lint: VHDL, ${#vhdl[@]} files: ASCII, at most 100 columns, no tabs, no case"
if grep -nP '[^\x00-\x7F]|\t|.{101,}' "${vhdl[@]}"; then
  echo "lint: the lines above have a tab, a character outside ASCII or over 100 columns" >&2
  exit 1
fi
mapfile -t rtl < <(git ls-files -- 'rtl/*.vhd')
if grep -nwiE 'case|when[[:space:]]+others' "${rtl[@]}" | grep -v -- '--.*case'; then
  echo "lint: GHDL drops 'when others' from its Verilog: use if/elsif in rtl/" >&2
  exit 1
fi

echo "lint: ghdl -a --std=93, all warnings that GHDL 2.0 has, as errors"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for prim in generic xc4v; do
  mkdir "$work/$prim"
  ghdl -a --std=93 --work=unisim --workdir="$work/$prim" tb/sim/vcomponents.vhd
  while read -r file; do
    ghdl -a --std=93 --work=raplas --workdir="$work/$prim" -P"$work/$prim" --warn-error \
      -Wlibrary -Wbinding -Wport -Wreserved -Wparenthesis -Wbody -Wspecs -Wshared -Wothers -Wpure \
      -Wuseless -Whide -Wunused -Wstatic -Wattribute \
      "rtl/${file//@PRIM@/$prim}"
  done < rtl/sources.txt
done

echo "lint: clang-tidy, ${#sources[@]} files"
# a file that several targets compile is checked once
python3 - "$build/compile_commands.json" "$work/compile_commands.json" <<'PYTHON'
import json, sys
commands = {command["file"]: command for command in json.load(open(sys.argv[1]))}
json.dump(list(commands.values()), open(sys.argv[2], "w"))
PYTHON
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 2 clang-tidy --quiet -p "$work" 2>"$work/tidy" || {
  grep -v 'warnings generated' "$work/tidy" >&2
  exit 1
}
echo "lint: clean"
