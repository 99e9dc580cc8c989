#!/usr/bin/env bash
# Makes the README's pictures again: docs/poplar.jpg, docs/poplar_closeup.jpg, docs/junctions.jpg, docs/base.jpg
# and docs/wireframe.png.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/scripts/build.sh" --target cambium
render() { "$top/build/cambium" render "$@"; }
render "$top/examples/poplar.tree.toml" -o "$top/docs/poplar.jpg" --size 900x1200
render "$top/examples/poplar_closeup.tree.toml" -o "$top/docs/poplar_closeup.jpg" --size 900x1200
render "$top/examples/junctions.blob.json" -o "$top/docs/junctions.jpg" --size 1400x420 --samples 16 \
  --set render.camera.azimuth=-90 --set render.camera.elevation=6 --set render.camera.fov=20 \
  --set 'bark.style="smooth"' --set 'bark.color="#b9ad9a"' --set 'bark.crack_color="#a89c88"'
render "$top/examples/bases/moreton_bay_fig.tree.toml" -o "$top/docs/base.jpg" --samples 1..8

# A junction, and twigs of millimetres on half a metre of wood, both at 1 mm.
meshes=$(mktemp -d)
trap 'rm -rf "$meshes"' EXIT
"$top/build/cambium" mesh "$top/examples/poplar_closeup.tree.toml" -o "$meshes/poplar.ply" --tolerance 1mm --no-ao
"$top/build/cambium" mesh "$top/examples/presets/sprouts.tree.toml" -o "$meshes/sprouts.ply" --tolerance 1mm --no-ao
"$top/scripts/wireframe.py" "$top/docs/wireframe.png" --size 700x700 \
  --panel "$meshes/poplar.ply" 0.065 0.1 2.435 20 20 0.3 --panel "$meshes/sprouts.ply" 0.16 0.15 1.41 66 10 0.34
