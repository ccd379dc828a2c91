#!/usr/bin/env bash
# Builds Kerf: build/PRESET/kerf. Usage: scripts/build.sh [PRESET [TARGET...]], by default the whole release preset.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
targets=("${@:2}")

# Objects seen before come from the compiler cache, where there is one.
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

# A heavy translation unit takes about 1 GB; more jobs than memory allows would swap.
memory_gb=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
jobs=$(nproc)
((memory_gb >= jobs)) || jobs=$((memory_gb > 0 ? memory_gb : 1))

cmake --preset "$preset" "${launcher[@]}" >/dev/null
cmake --build "build/$preset" --parallel "$jobs" ${targets[@]+--target "${targets[@]}"}
