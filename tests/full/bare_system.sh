#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Run as root. Sets up a bare Debian 12 in a folder, builds the programs and saves a picture.
# Proves that deploy/setup.sh names all needed packages. Needs debootstrap and 6 GB.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/full/bare_debian.sh
root="${1:-build/bare-system}"

make_bare_debian "$root"
mkdir -p "$root/src"
git ls-files -z | tar --create --null --files-from=- | tar --extract --directory "$root/src"
in_bare_debian "$root" '
  cd /src
  deploy/setup.sh
  cmake --preset release -DVIEWLOOM_TESTS=OFF
  cmake --build build/release --parallel "$(nproc)"
  cmake --install build/release --prefix /usr/local --strip
  viewloomd doctor
  viewloomd serve & server=$!
  viewloom publish --synthetic & publisher=$!
  trap "kill $publisher $server; wait" EXIT
  viewloom watch --count 1 --out /tmp/picture
  ls -l /tmp/picture'
