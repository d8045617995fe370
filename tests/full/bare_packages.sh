#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Run as root. Makes the Debian packages and installs them in a bare Debian 12. Proves that they
# name all their dependencies. Needs debootstrap, the tools of deploy/package.sh, and 3 GB.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/full/bare_debian.sh
root="${1:-build/bare-packages}"

deploy/package.sh
make_bare_debian "$root"
rm -rf "$root/packages" "$root/external"
mkdir -p "$root/packages"
cp build/packages/*.deb "$root/packages/"
cp -r tests/install/external "$root/external"
in_bare_debian "$root" '
  apt-get -q update
  apt-get -q -y install --no-install-recommends \
    /packages/viewloomd_*.deb /packages/viewloom_*.deb mesa-vulkan-drivers
  viewloom --version
  grep -x "ExecStart=/usr/bin/viewloomd serve --config /etc/viewloom/viewloomd.toml" \
    /lib/systemd/system/viewloomd.service
  viewloomd doctor --config /etc/viewloom/viewloomd.toml
  viewloomd serve --config /etc/viewloom/viewloomd.toml & server=$!
  viewloom publish --synthetic --stream packaged & publisher=$!
  trap "kill $publisher $server; wait" EXIT
  viewloom watch packaged --count 1 --out /tmp/picture
  ls -l /tmp/picture

  apt-get -q -y install --no-install-recommends /packages/python3-viewloom_*.deb
  python3 -c "import viewloom; print(viewloom.Server().streams())"

  apt-get -q -y install --no-install-recommends \
    /packages/libviewloom-client*.deb cmake g++ make pkg-config
  cmake -S /external -B /tmp/external
  cmake --build /tmp/external
  /tmp/external/list_streams 127.0.0.1:50051 | grep -x packaged
  g++ -std=c++20 /external/list_streams.cpp -o /tmp/list_streams \
    $(pkg-config --cflags --libs viewloom-client)
  /tmp/list_streams 127.0.0.1:50051 | grep -x packaged

  apt-get -q -y purge viewloomd viewloom python3-viewloom libviewloom-client-dev libviewloom-client0
  test ! -e /etc/viewloom && test ! -e /usr/include/viewloom && test ! -e /usr/share/viewloom'
echo "the packages work in a bare system"
