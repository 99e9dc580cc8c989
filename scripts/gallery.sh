#!/usr/bin/env bash
# Makes the pictures of docs/gallery.md again, docs/gallery/*.jpg: one of every recipe in examples/lsystems/, a tree as it grows, and
# sheets of the recipes in examples/graphs/. `gallery.sh graphs` makes the sheets alone.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
pictures=$top/docs/gallery

if ! command -v montage > /dev/null; then
  echo "gallery.sh: montage and convert are needed, of the package imagemagick" >&2
  exit 1
fi
"$top/scripts/build.sh" --target cambium
mkdir -p "$pictures"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

render() { "$top/build/cambium" render "$@" --quiet; }

lsystems() {
  for recipe in "$top"/examples/lsystems/*.tree.toml; do
    render "$recipe" -o "$pictures/$(basename "$recipe" .tree.toml).jpg"
  done
  render "$top/examples/growing.tree.toml" -o "$pictures/growing.jpg" --step 1.25
}

# A black silhouette beside the still.
graph_pair() {
  local recipe=$top/examples/graphs/$1.tree.toml
  render "$recipe" -o "$work/still.png"
  render "$recipe" -o "$work/matte.png" --bounces 0 --set render.background=transparent --set render.light.ground=false
  convert "$work/matte.png" -channel RGB -evaluate set 0 +channel -background white -flatten "$work/silhouette.png"
  convert "$work/silhouette.png" "$work/still.png" +append "$work/$1.png"
}

# graph_sheet NAME RECIPE...: docs/gallery/graphs_NAME.jpg, four pairs in a row.
graph_sheet() {
  local name=$1 cells=()
  shift
  for recipe in "$@"; do
    graph_pair "$recipe"
    cells+=("$work/$recipe.png")
  done
  montage "${cells[@]}" -tile 4x -geometry x260+3+3 "$work/sheet.png"
  convert "$work/sheet.png" -strip -quality 82 "$pictures/graphs_$name.jpg"
}

graphs() {
  graph_sheet table_2 table_2{a,b,c,d,e,f,g,h,i,j,k,l,m,n,o}
  graph_sheet volumes fig06_dendrite fig09_tilted fig13_{plain,refined} fig14_{umbrella,two_tiers,flame} mesh_heart
  graph_sheet levels fig10_{thick,thin} fig11_{thick,thin} fig15_{a07,a10} fig16_willow
  graph_sheet growth fig17_{bush,tree} fig18_{none,light} fig19_light fig24_{taproot,spreading}
}

if [ "${1:-all}" = all ]; then lsystems; fi
graphs
