#!/usr/bin/env bash
# Puts .glb files through the Khronos validator and ends with status 1 if it finds an error in one of them. Without arguments the
# program first makes some to validate. The validator is an npm package; it is kept in the build folder.
# Usage: scripts/validate_gltf.sh [file.glb ...]
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="${CAMBIUM_BUILD:-$top/build}"
tools="$build/gltf-validator"

if ! command -v node > /dev/null || ! command -v npm > /dev/null; then
  echo "validate_gltf.sh: node and npm are needed (scripts/packages.sh installs them)" >&2
  exit 1
fi
if [ ! -d "$tools/node_modules/gltf-validator" ]; then
  mkdir -p "$tools"
  npm install --prefix "$tools" --no-audit --no-fund --silent gltf-validator@2.0.0-dev.3.10
fi

files=("$@")
if [ ${#files[@]} -eq 0 ]; then
  made="$tools/made"
  mkdir -p "$made"
  "$build/cambium" mesh "$top/examples/presets/oak.tree.toml" -o "$made/oak.glb" --quiet
  "$build/cambium" mesh "$top/examples/presets/oak.tree.toml" -o "$made/levels.glb" --lod 60k,20k,10k --quiet
  "$build/cambium" mesh "$top/examples/lsystems/abop_1_25.tree.toml" -o "$made/leaves.glb" --set skeleton.steps=4 --tolerance 2cm --quiet
  files=("$made/oak.glb" "$made/levels.glb" "$made/leaves.glb")
fi

NODE_PATH="$tools/node_modules" node - "${files[@]}" <<'SCRIPT'
const fs = require('fs');
const validator = require('gltf-validator');
const names = ['errors', 'warnings', 'infos', 'hints'];
(async () => {
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {uri: file, maxIssues: 1000});
    const counts = [report.issues.numErrors, report.issues.numWarnings, report.issues.numInfos, report.issues.numHints];
    console.log(`${file}: ${names.map((name, i) => `${counts[i]} ${name}`).join(', ')}`);
    for (const issue of report.issues.messages)
      if (issue.severity < 2) console.log(`  ${issue.code} at ${issue.pointer}: ${issue.message}`);
    if (counts[0] > 0) process.exitCode = 1;
  }
})();
SCRIPT
