# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# Sourced, as root: a bare Debian 12 in a folder, and commands in it. Needs debootstrap.

# make_bare_debian FOLDER: it takes packages from where this machine takes them.
make_bare_debian() {
  local root="$1"
  if [[ ! -e "$root/etc/debian_version" ]]; then
    mkdir -p "$root"
    debootstrap --variant=minbase bookworm "$root"
  fi
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  # Debian's installer writes it, debootstrap does not.
  echo '127.0.0.1 localhost' > "$root/etc/hosts"
  rm -f "$root/etc/apt/sources.list"
  cp -r /etc/apt/sources.list* /etc/apt/trusted.gpg.d "$root/etc/apt/"
  cp -r /usr/share/keyrings "$root/usr/share/"
  # Proxies and the like, but no hooks that call programs of this machine.
  apt-config dump | grep '^Acquire::' > "$root/etc/apt/apt.conf.d/90-this-machine" || true
}

# in_bare_debian FOLDER COMMANDS: of bash, which end at the first that fails.
in_bare_debian() {
  (
    root="$1"
    places=(proc sys dev)
    for place in "${places[@]}"; do mount --rbind "/$place" "$root/$place"; done
    unmount() {
      for place in "${places[@]}"; do
        # Else unmounting would reach the places themselves.
        mount --make-rslave "$root/$place"
        umount --recursive "$root/$place"
      done
    }
    trap unmount EXIT
    chroot "$root" env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
      LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive bash -euc "$2"
  )
}
