#!/usr/bin/env bash
# Checks the format of every source, looks over the Python scripts and runs clang-tidy over the library and the
# program; skips a tool that is missing.
# Usage: scripts/lint.sh [--format | --thorough]
#   --format    the format and the Python scripts alone, which takes a second; clang-tidy takes minutes
#   --thorough  also the tests, and clang's slow static analyzer
set -euo pipefail
cd "$(dirname "$0")/.."

folders=(models forward data inverse)
checks='-clang-analyzer-*'
if [[ "${1:-}" == --thorough ]]; then
  folders+=(tests)
  checks=''
fi

if command -v clang-format >/dev/null; then
  echo "== clang-format"
  git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format --dry-run --Werror
fi

if command -v pyflakes3 >/dev/null; then
  echo "== pyflakes"
  git ls-files -z '*.py' | xargs -0 pyflakes3
fi

if [[ "${1:-}" != --format ]] && command -v clang-tidy >/dev/null; then
  echo "== clang-tidy: ${folders[*]}"
  cmake --preset release >/dev/null
  git ls-files -z "${folders[@]/%//*.cpp}" |
    xargs -0 --max-procs="$(nproc)" --max-args=1 clang-tidy --quiet --checks="$checks" -p build/release 2>/dev/null
fi
