#!/usr/bin/env bash
# Installs the Debian/Ubuntu packages that Cambium is built with, if any is missing. Called by the other scripts.
set -euo pipefail

packages=(
  build-essential cmake ninja-build ccache
  libglm-dev libtbb-dev libfmt-dev libhwy-dev
  libopenmesh-dev libtinygltf-dev nlohmann-json3-dev libopenvdb-dev libboost-dev
  libembree-dev libopenimageio-dev
  libcli11-dev libtomlplusplus-dev
  libgtest-dev libgmock-dev libbenchmark-dev libnanoflann-dev libcgal-dev python3 python3-openvdb
)
# The glTF validator's: any node that is there will do, Debian's must not come in beside another.
command -v node > /dev/null || packages+=(nodejs npm)

if ! command -v dpkg-query > /dev/null; then
  echo "packages.sh: this is not Debian or Ubuntu; the packages needed are: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2> /dev/null | grep -q 'install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "packages.sh: these packages are missing and there is no sudo to install them: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
