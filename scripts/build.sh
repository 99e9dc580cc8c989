#!/usr/bin/env bash
# Builds build/ in release mode. Called by the other scripts; arguments (such as --target NAME) are given to the build.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/scripts/packages.sh"
cmake -S "$top" -B "$top/build" -G Ninja -DCMAKE_BUILD_TYPE=Release
cmake --build "$top/build" "$@"
