#!/bin/sh
# Unpacks what the cross compilers need of Debian 12 for another architecture; no foreign architecture is added to
# this machine's dpkg, and no package script runs.
#
#   sh toolchain/cross/sysroot.sh arm64|armhf      prints the folder: .cache/sysroot-<architecture>
#
# A folder that was made from the same list of packages and the same release is used again.
set -eu

arch=${1:-}
case $arch in
    arm64 | armhf) ;;
    *) echo "sysroot.sh: '$arch' is no architecture that dicot is built for; say arm64 or armhf" >&2; exit 64 ;;
esac
release=bookworm
packages=libc6-dev,libstdc++-12-dev,libdraco-dev,libpng-dev,libjpeg62-turbo-dev,libyaml-dev,libcli11-dev
packages=$packages,libmd-dev,nlohmann-json3-dev,libeigen3-dev,zlib1g-dev,libusb-1.0-0-dev,libtomlplusplus-dev,libsqlite3-dev

checkout=$(cd "$(dirname "$0")/../.." && pwd)
sysroot=$checkout/.cache/sysroot-$arch
recipe="2 $release $arch $packages"
if [ "$(cat "$sysroot/recipe" 2>/dev/null)" = "$recipe" ]; then
    echo "$sysroot"
    exit 0
fi

# The same archive that this machine installs from.
# shellcheck disable=SC2016 # apt-get's own words in the format
mirror=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
    awk -v release="$release" '$2 == release && $3 == "main" { print $1; exit }')
if [ -z "$mirror" ]; then
    echo "sysroot.sh: apt knows no source for '$release main'; add one and run 'apt-get update'" >&2
    exit 69
fi
if ! command -v mmdebstrap >/dev/null; then
    echo "sysroot.sh: mmdebstrap is missing; install the package mmdebstrap" >&2
    exit 69
fi

mkdir -p "$checkout/.cache"
fresh=$(mktemp -d "$checkout/.cache/sysroot-$arch.XXXXXX")
trap 'rm -rf "$fresh"' EXIT
mmdebstrap --quiet --variant=extract --architectures="$arch" --include="$packages" \
    --extract-hook="sh '$checkout/toolchain/cross/keep_packages.sh' \"\$1\"" "$release" "$fresh" "deb $mirror $release main" >&2
chmod 755 "$fresh"

# Absolute links would lead out of the sysroot into the machine itself.
find "$fresh" -path "$fresh/dev" -prune -o -type l -lname '/*' -print | while read -r link; do
    ln -snf "$(realpath -m --relative-to="$(dirname "$link")" "$fresh$(readlink "$link")")" "$link"
done
printf '%s\n' "$recipe" > "$fresh/recipe"
rm -rf "$sysroot"
mv "$fresh" "$sysroot"
trap - EXIT
echo "$sysroot"
