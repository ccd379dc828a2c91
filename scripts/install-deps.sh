#!/usr/bin/env bash
# Installs what Kerf needs from Debian's own packages. Quick when everything is there already.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config
  libboost-dev libeigen3-dev libceres-dev libnlopt-dev libnlopt-cxx-dev libhdf5-dev libssl-dev
  libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libfmt-dev libudunits2-dev
  libgtest-dev libgmock-dev libbenchmark-dev valgrind
  python3-matplotlib python3-h5py python3-jinja2
)

command -v dpkg-query >/dev/null || { echo "install-deps.sh: this script knows Debian only; needed: ${packages[*]}" >&2; exit 1; }

missing=()
for package in "${packages[@]}"; do
  [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null)" == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "install-deps.sh: everything is installed"
  exit 0
fi

as_root=()
if [[ $EUID -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "install-deps.sh: run as root, or install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "install-deps.sh: installing ${missing[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
