#!/usr/bin/env bash
# Measures what a step costs on this machine and prints one table; two to three minutes.
# Usage: scripts/bench.sh [--json FILE] [--repeats N] [--readme]     --readme puts the table in README.md
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release -DKERF_BENCH=ON >/dev/null
scripts/build.sh release kerf_bench
exec python3 scripts/bench.py build/release/tests/kerf_bench "$@"
