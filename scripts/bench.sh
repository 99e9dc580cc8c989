#!/usr/bin/env bash
# Installs what is missing, builds the benchmarks in build-bench/ and prints one table: what the field costs on this machine, beside
# the machine's own limit. Takes about three minutes on an idle machine. Arguments are given to the program:
#   --quick         less time: ratios are then rough
#   --json FILE     the table's rows as JSON too
#   --only SECTION  one section of the table (--help lists them); `mesher`, ours against OpenVDB's at equal error, runs only so
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

(
  "$top/scripts/packages.sh"
  cd "$top"
  cmake --preset bench
  cmake --build --preset bench --target cambium_bench
) >&2
exec "$top/build-bench/bench/cambium_bench" "$@"
