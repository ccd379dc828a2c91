#!/usr/bin/env bash
# Everything that guards the project: install, sanitizer build with the quick tests, format, release build with all
# tests. (scripts/lint.sh runs clang-tidy as well, for minutes.)
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-deps.sh

echo "== quick tests under the address and undefined-behaviour sanitizers"
scripts/build.sh asan-ubsan test_unit test_laws
ctest --test-dir build/asan-ubsan --label-regex '^(unit|laws)$' --parallel 2 --output-on-failure

scripts/lint.sh --format

echo "== all tests, release build"
scripts/build.sh release
ctest --test-dir build/release --parallel 2 --output-on-failure
