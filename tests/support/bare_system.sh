#!/bin/sh
# A tar of `make bundle` in a bare Debian of another release: bare_system.sh SUITE TAR   as root; the system is kept for the next call
#   BARE=folder   where it is kept; /var/tmp/langer-bare by default
# Nothing is installed there but make. A starter is run as a user who is not root, from a folder with a blank and an umlaut in its name.
set -eu
suite=$1 tar=$(readlink -f "$2")
base=${BARE:-/var/tmp/langer-bare}
root=$base/$suite
[ "$(id -u)" = 0 ] || { echo "skipped: a bare system is made by root"; exit 77; }
command -v debootstrap > /dev/null || { echo "skipped: no debootstrap"; exit 77; }
if [ ! -f "$base/$suite.done" ]; then
  mirror=$(cat /etc/apt/sources.list.d/*.sources /etc/apt/sources.list 2>/dev/null | sed -n 's/^URIs: *\([^ ]*\).*/\1/p; s/^deb \(\[[^]]*\] \)\?\([^ ]*\) .*/\2/p' | sed -n 1p)
  rm -rf "$root" && mkdir -p "$base"
  debootstrap --variant=minbase --include=make "$suite" "$root" "$mirror" > "$base/$suite.log" 2>&1 || { tail -5 "$base/$suite.log"; exit 1; }
  touch "$base/$suite.done"
fi
name=$(basename "$tar" .tar.gz)
at="$root/home/user/Löcher und Haut"
rm -rf "$root/home/user" && mkdir -p "$at"
tar -xf "$tar" -C "$at" --no-same-owner
chown -R 1000:1000 "$root/home/user"
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
trap 'umount -l "$root/proc"' EXIT
env -i PATH=/usr/sbin:/usr/bin:/bin HOME=/home/user LANG=C.UTF-8 chroot --userspec=1000:1000 "$root" sh -ec '
  cd "/home/user/Löcher und Haut"
  PATH=$PWD/'"$name"'/bin:$PATH
  cat /etc/debian_version; ldd --version | head -1
  langer doctor
  langer new indentation skin
  make -C skin
  langer show skin/run/post/curves.h5
  ls skin/run/report/report.html
  printf "geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}\nexport: [msh]\n" > block.yaml
  printf "geometry: {file: {path: block.msh}}\n" > file.yaml
  langer-mesh block.yaml -o block.h5
  langer-mesh file.yaml -o file.h5'
echo "$suite: $name runs"
