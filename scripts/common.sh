# Sourced by the other scripts: packages, build, messages. Works from any folder.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${POLYSLIP_BUILD:-$root/build}

packages=(
  g++ cmake ninja-build pkg-config ccache git ca-certificates
  petsc-dev libpetsc-real-dev libopenmpi-dev openmpi-bin libscotch-dev
  libhdf5-openmpi-dev libeigen3-dev libtomlplusplus-dev libcli11-dev libfmt-dev libspdlog-dev
  nlohmann-json3-dev voro++-dev libnanoflann-dev libgmsh-dev libnglib-dev libpng-dev zlib1g-dev
  libgtest-dev libbenchmark-dev clang-format-14 python3 python3-h5py
)

# What only the tests take: a browser for the report.
test_packages=(chromium chromium-driver python3-selenium)
# npm builds the report's page; it may be there without being a package.
command -v npm >/dev/null || packages+=(nodejs npm)

say() { printf '\n== %s\n' "$*"; }

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# Installs what is missing; asks the package manager nothing when nothing is.
install_packages() {
  local missing=()
  for package in "${packages[@]}"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then
    say "packages: all ${#packages[@]} are there"
    return
  fi
  say "packages: installing ${missing[*]}"
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# build_targets TARGET...: configures once and builds.
build_targets() {
  say "build: $build"
  if [ ! -f "$build/build.ninja" ]; then
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release
  fi
  cmake --build "$build" --target "$@"
}
