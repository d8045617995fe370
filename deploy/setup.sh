#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages viewloom needs. Safe to repeat: what is installed is left alone.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: deploy/setup.sh [--runtime | --dev | --hardware-video]
  (no option)  what it takes to build viewloomd and viewloom, and to run them
  --runtime    only what built programs need to run
  --dev        what it takes to build, and what only the tests need
  --hardware-video  what it takes to build with VIEWLOOM_HARDWARE_VIDEO (deploy/video.md)
TEXT
}

# A Vulkan device in software (lavapipe) comes with mesa-vulkan-drivers; a GPU's own driver is used
# where there is one.
runtime_packages=(
  ca-certificates fonts-dejavu-core libabsl20220623 libepoxy0 libgl1 libgrpc++1.51 libheif1 libhwy1
  libjpeg62-turbo libopenexr-3-1-30 libopenh264-7 libpng16-16 libprometheus-cpp-core1.0 libprotobuf32 libqrencode4 libsdl2-2.0-0
  libseccomp2 libsdl2-ttf-2.0-0 libspdlog1.10 libssl3 libtiff6 libtomlplusplus3 libturbojpeg0 libvulkan1 libwebp7 libwebpdemux2 libzstd1
  mesa-vulkan-drivers zlib1g
)
build_packages=(
  ccache cmake g++ git mold ninja-build pkg-config python3
  glslang-tools libvulkan-dev mesa-vulkan-drivers libglm-dev
  libabsl-dev libgrpc++-dev libhwy-dev libprotobuf-dev protobuf-compiler protobuf-compiler-grpc grpc-proto
  libheif-dev libjpeg62-turbo-dev libturbojpeg0-dev libopenexr-dev libopenh264-dev libpng-dev libtiff-dev libwebp-dev
  libzstd-dev zlib1g-dev
  libboost-dev libcli11-dev libqrencode-dev libspdlog-dev libssl-dev libtomlplusplus-dev nlohmann-json3-dev
  libseccomp-dev prometheus-cpp-dev
  fonts-dejavu-core libepoxy-dev libsdl2-dev libsdl2-ttf-dev
)
# Under the GPL in Debian: only for VIEWLOOM_HARDWARE_VIDEO.
hardware_video_packages=(libavcodec-dev libavutil-dev)
test_packages=(
  libbenchmark-dev libgmock-dev libgtest-dev libimage-exiftool-perl vulkan-validationlayers
  chromium curl openssl python3-grpcio python3-numpy python3-pil python3-protobuf python3-zstandard mypy
  python3-pip python3-setuptools python3-venv python3-wheel
  haproxy man-db nginx-light openssl xdotool xvfb zsh
  clang clang-format clang-tidy libembree-dev llvm
)
# Node from elsewhere is as good, and Debian's npm cannot be installed beside it.
command -v node >/dev/null || test_packages+=(nodejs)
command -v npm >/dev/null || test_packages+=(npm)

case "${1:-}" in
  "") packages=("${build_packages[@]}") ;;
  --runtime) packages=("${runtime_packages[@]}") ;;
  --dev) packages=("${build_packages[@]}" "${test_packages[@]}") ;;
  --hardware-video) packages=("${build_packages[@]}" "${hardware_video_packages[@]}") ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac

system="$(. /etc/os-release 2>/dev/null && echo "${ID:-} ${VERSION_ID:-}" || true)"
if [[ "$system" != "debian 12" ]]; then
  echo "setup: this is \"${system:-an unknown system}\"; viewloom is built and tested on Debian 12" \
    "(bookworm). Use deploy/Containerfile here, or install by hand what Debian calls:" >&2
  echo "  ${packages[*]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  state="$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)"
  [[ "$state" == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "setup: all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if [[ "$(id -u)" -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: ${#missing[@]} packages are missing and there is no sudo; as root, run:" >&2
    echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o Dpkg::Use-Pty=0 "$@"
}
lists_are_new=no
update_lists() {
  [[ $lists_are_new == no ]] || return 1
  echo "setup: fetching the package lists"
  apt update
  lists_are_new=yes
}
install_missing() {
  apt install -y --no-install-recommends "${missing[@]}"
}

echo "setup: installing ${#missing[@]} of ${#packages[@]} packages: ${missing[*]}"
# Lists that are absent or older than the archive show as a plan or a download that fails.
apt install --simulate --no-install-recommends "${missing[@]}" >/dev/null 2>&1 || update_lists
install_missing || { update_lists && install_missing; } || {
  echo "setup: apt-get could not install them; its message is above" >&2
  exit 1
}
echo "setup: done"
