#!/usr/bin/env bash
# Makes the pictures of docs/gallery.md again, docs/gallery/*.jpg: one of every recipe in examples/lsystems/,
# and a tree as it grows.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/scripts/build.sh" --target cambium
mkdir -p "$top/docs/gallery"
for recipe in "$top"/examples/lsystems/*.tree.toml; do
  "$top/build/cambium" render "$recipe" -o "$top/docs/gallery/$(basename "$recipe" .tree.toml).jpg"
done
"$top/build/cambium" render "$top/examples/growing.tree.toml" -o "$top/docs/gallery/growing.jpg" --step 1.25
