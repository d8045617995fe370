#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds viewloom and makes Debian packages of it, in build/packages. The project has no maintainer in
# Debian: whoever passes packages on names themselves with DEBFULLNAME and DEBEMAIL, as for other
# tools of Debian.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<'TEXT'
usage: deploy/package.sh
  Makes build/packages/*.deb: viewloomd, viewloom, libviewloom-client0, libviewloom-client-dev and
  python3-viewloom. Needs what deploy/setup.sh installs, debhelper, dh-python and dpkg-dev. If lintian
  is installed, its errors end this script. DEBFULLNAME and DEBEMAIL name the maintainer of packages
  that you pass on.
TEXT
}
case "${1:-}" in
  "") ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac

missing=()
for package in cmake debhelper dh-python dpkg-dev ninja-build python3; do
  state="$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)"
  [[ "$state" == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -ne 0 ]]; then
  echo "package: these Debian packages are missing: ${missing[*]}" >&2
  echo "package: install them with: apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

source="$PWD"
out="$source/build/packages"
build="$source/build/package"  # as deep as build/release, whose objects ccache then takes
multiarch="$(dpkg-architecture -qDEB_HOST_MULTIARCH)"
# The objects are those of the preset release, which the tests run. Debian's flags are for linking.
hardening="$(DEB_BUILD_MAINT_OPTIONS=hardening=+bindnow dpkg-buildflags --get LDFLAGS)"
cmake --preset release -B "$build" -DVIEWLOOM_TESTS=OFF -DCMAKE_INSTALL_PREFIX=/usr \
  -DCMAKE_INSTALL_LIBDIR="lib/$multiarch" -DVIEWLOOM_PYTHON_DIR=lib/python3/dist-packages \
  -DVIEWLOOM_ZSH_DIR=share/zsh/vendor-completions \
  -DCMAKE_EXE_LINKER_FLAGS="$hardening" -DCMAKE_SHARED_LINKER_FLAGS="$hardening"
cmake --build "$build" --parallel "$(nproc)"

# debhelper wants a folder debian/, which has the version and the date of this tree.
version="$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")-1"
date="$(git log -1 --format=%cD 2>/dev/null || date -R)"
maintainer="${DEBFULLNAME:-unpublished local build} <${DEBEMAIL:-nobody@example.org}>"
tree="$out/tree"
rm -rf "$tree" "$out"/*.deb "$out"/*.buildinfo "$out"/*.changes
mkdir -p "$tree"
cp -r deploy/debian "$tree/debian"
sed -i "s/@MAINTAINER@/$maintainer/" "$tree/debian/control"
cat > "$tree/debian/changelog" <<TEXT
viewloom ($version) bookworm; urgency=medium

  * Changes are in changelog.gz.

 -- $maintainer  $date
TEXT
(cd "$tree" && VIEWLOOM_SOURCE="$source" VIEWLOOM_BUILD="$build" \
  dpkg-buildpackage --build=binary --no-sign)

if command -v lintian >/dev/null; then
  lintian --fail-on error "$out"/*.changes
else
  echo "package: lintian is not installed, so the packages are unchecked"
fi
ls -l "$out"/*.deb
