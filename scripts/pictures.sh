#!/usr/bin/env bash
# Makes the README's pictures again: docs/poplar.png, docs/poplar_closeup.png and docs/junctions.png.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/scripts/build.sh" --target cambium
render() { "$top/build/cambium" render "$@"; }
render "$top/examples/poplar.tree.toml" -o "$top/docs/poplar.png"
render "$top/examples/poplar_closeup.tree.toml" -o "$top/docs/poplar_closeup.png"
render "$top/examples/junctions.blob.json" -o "$top/docs/junctions.png" --size 1400x420 --samples 16 \
  --set render.camera.azimuth=-90 --set render.camera.elevation=6 --set render.camera.fov=20 \
  --set 'bark.style="smooth"' --set 'bark.color="#b9ad9a"' --set 'bark.crack_color="#a89c88"'
