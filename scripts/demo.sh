#!/usr/bin/env bash
# Installs what is missing, builds the program in release mode in build/ and makes the poplar: out/poplar.png, out/poplar.glb, out/poplar.vdb.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/scripts/build.sh" --target cambium
recipe=$top/examples/poplar.tree.toml
mkdir -p "$top/out"

report=()
make_one() {  # command, output
  local figures
  figures=$("$top/build/cambium" "$1" "$recipe" -o "$2" --json)
  report+=("$(python3 -c '
import json, os, sys
figures = json.loads(sys.argv[1])
stages = ", ".join(f"{name} {seconds:.2f}" for name, seconds in figures["seconds"].items() if name != "total")
print("{}: {:.1f} MB in {:.1f} s (peak memory {:.0f} MB; seconds: {})".format(
    sys.argv[2], os.path.getsize(sys.argv[2]) / 1e6, figures["seconds"]["total"], figures["peak_memory_bytes"] / 1e6, stages))
' "$figures" "$2")")
}
make_one render "$top/out/poplar.png"
make_one mesh "$top/out/poplar.glb"
make_one volume "$top/out/poplar.vdb"
printf '%s\n' "${report[@]}"
