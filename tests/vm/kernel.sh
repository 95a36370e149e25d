#!/bin/sh
# Fetches what the virtual machine boots: Debian 12's arm64 kernel with its modules, busybox, and v4l2-ctl with its
# libraries. No foreign architecture is added to this machine's dpkg, and no package script runs.
#
#   sh tests/vm/kernel.sh      prints the folder: .cache/vm-arm64
#
# In the folder: vmlinuz, lib/modules/<version>, version (the kernel's), recipe, bin/busybox, usr/bin/v4l2-ctl.
# A folder that was made from the same recipe is used again.
set -eu

release=bookworm
packages=linux-image-arm64,busybox-static,v4l-utils
recipe="2 $release arm64 $packages"

checkout=$(cd "$(dirname "$0")/../.." && pwd)
tree=$checkout/.cache/vm-arm64
if [ "$(cat "$tree/recipe" 2>/dev/null)" = "$recipe" ]; then
    echo "$tree"
    exit 0
fi

for program in mmdebstrap depmod; do
    command -v $program >/dev/null && continue
    echo "kernel.sh: $program is missing; install the packages mmdebstrap and kmod" >&2
    exit 69
done
# The same archive that this machine installs from.
# shellcheck disable=SC2016 # apt-get's own words in the format
mirror=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
    awk -v release="$release" '$2 == release && $3 == "main" { print $1; exit }')
if [ -z "$mirror" ]; then
    echo "kernel.sh: apt knows no source for '$release main'; add one and run 'apt-get update'" >&2
    exit 69
fi

mkdir -p "$checkout/.cache"
fresh=$(mktemp -d "$checkout/.cache/vm-arm64.XXXXXX")
trap 'rm -rf "$fresh"' EXIT
if ! mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$packages" "$release" "$fresh" \
    "deb $mirror $release main" >&2; then
    echo "kernel.sh: cannot fetch Debian's arm64 kernel ($packages): check the network, or run 'apt-get update'" >&2
    exit 69
fi
set -- "$fresh"/boot/vmlinuz-*
version=${1##*/vmlinuz-}
mv "$1" "$fresh/vmlinuz"
depmod -b "$fresh" "$version"
for folder in boot usr/share var etc dev; do
    rm -rf "${fresh:?}/$folder"
done
chmod 755 "$fresh"
printf '%s\n' "$version" >"$fresh/version"
printf '%s\n' "$recipe" >"$fresh/recipe"
rm -rf "$tree"
mv "$fresh" "$tree"
trap - EXIT
echo "$tree"
