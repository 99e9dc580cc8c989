#!/usr/bin/env bash
# Installs what is missing, builds build/ in release mode and runs all tests.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/scripts/build.sh"
ctest --test-dir "$top/build" --output-on-failure -j2
