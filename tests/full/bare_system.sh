#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# As root: a bare Debian 12 in a folder, which gets the packages, builds the programs and shows a
# picture. Proves that deploy/setup.sh names all that is needed. Needs debootstrap and 6 GB.
set -euo pipefail
cd "$(dirname "$0")/../.."
root="${1:-build/bare-system}"

if [[ ! -e "$root/etc/debian_version" ]]; then
  mkdir -p "$root"
  debootstrap --variant=minbase bookworm "$root"
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"
mkdir -p "$root/src"
git ls-files -z | tar --create --null --files-from=- | tar --extract --directory "$root/src"

places=(proc sys dev)
for place in "${places[@]}"; do mount --rbind "/$place" "$root/$place"; done
unmount() {
  local place
  for place in "${places[@]}"; do
    # Else unmounting would reach the places themselves.
    mount --make-rslave "$root/$place"
    umount --recursive "$root/$place"
  done
}
trap unmount EXIT

chroot "$root" env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  bash -euc '
    cd /src
    deploy/setup.sh
    cmake --preset release -DVIEWLOOM_TESTS=OFF
    cmake --build build/release --parallel "$(nproc)"
    cmake --install build/release --prefix /usr/local --strip
    viewloomd doctor
    viewloomd serve & server=$!
    viewloom publish --synthetic & publisher=$!
    trap "kill $publisher $server" EXIT
    viewloom watch --count 1 --out /tmp/picture
    ls -l /tmp/picture'
