#!/usr/bin/env bash
# Meshes every preset at several seeds and has each mesh measured. Prints a table; fails if any mesh is not what was promised:
# closed, manifold, free of crossings, of positive volume, and within the recipe's tolerance both ways for 99.9 % of samples and
# within twice that for all; what lies in cracks narrower than the tolerance is counted apart.
# Usage: scripts/check_presets.sh [seeds, 10 unless told] [program, build/cambium unless told]
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
seeds=${1:-10}
program=${2:-$top/build/cambium}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 - "$program" "$top/examples/presets" "$seeds" "$work" << 'CHECK'
import json, pathlib, subprocess, sys

program, presets, seeds, work = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
row = "{:<13} {:>4} {:>9} {:>6} {:>5} {:>6} {:>5} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8}  {}"
print(row.format("preset", "seed", "triangles", "pieces", "euler", "broken", "cross", "s",
                 "m>s p999", "m>s max", "s>m p999", "s>m max", "cracks", "(distances in tolerances)"))
failures = 0
recipes = sorted(presets.glob("*.tree.toml"))
for recipe in recipes:
    name = recipe.name.removesuffix(".tree.toml")
    for seed in range(1, seeds + 1):
        ran = subprocess.run([program, "mesh", str(recipe), "--seed", str(seed), "-o", work + "/tree.ply", "--verify", "--json"],
                             capture_output=True, text=True)
        if ran.returncode != 0:
            failures += 1
            print(f"{name:<13} {seed:>4} failed: {ran.stderr.strip()}")
            continue
        f = json.loads(ran.stdout)
        v = f["verify"]
        t, ways = v["topology"], [v["mesh_to_surface"], v["open_surface_to_mesh"]]
        broken = sum(t[k] for k in ("boundary_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate_triangles",
                                    "unused_vertices"))
        wrong = []
        if broken: wrong.append("not a closed manifold")
        if v["self_intersections"]: wrong.append("crosses itself")
        if not t["volume"] > 0: wrong.append("no volume")
        for way in ways:
            if way["within_tolerance"] < 0.999: wrong.append("too far")
            if way["within_twice"] < 1: wrong.append("beyond twice at {:.4f} {:.4f} {:.4f}".format(*way["max_at"]))
        unit = f["tolerance"]
        figures = [f"{way[k] / unit:.2f}" if way[k] is not None else "none" for way in ways for k in ("p999", "max")]
        print(row.format(name, seed, f["triangles"], t["components"], t["euler"], broken, v["self_intersections"],
                         f"{f['seconds']['polygonize']:.2f}", *figures, "{:.3f} %".format(100 * v["in_cracks"] / v["surface_to_mesh"]["samples"]), "; ".join(wrong)), flush=True)
        failures += bool(wrong)
print(f"{len(recipes) * seeds} meshes, {failures} of them not as promised")
sys.exit(failures > 0 or not recipes)
CHECK
