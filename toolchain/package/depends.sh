#!/bin/sh
# What the program's libraries ask of Debian, as dpkg-shlibdeps says: one line for the field Depends.
#
#   depends.sh PROGRAM OUTPUT ARCHITECTURE [SYSROOT]
#
# Of a sysroot the lists of files and the control files of its packages are read (sysroot.sh keeps them), never this
# machine's.
set -eu
program=$1
output=$2
architecture=$3
sysroot=${4:-}

if ! command -v dpkg-shlibdeps >/dev/null; then
    echo "depends.sh: dpkg-shlibdeps is missing; install the package dpkg-dev" >&2
    exit 69
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/debian"
printf 'Source: dicot\n\nPackage: dicot\nArchitecture: any\n' >"$work/debian/control"

set -- --ignore-missing-info
if [ -n "$sysroot" ]; then
    case $architecture in
        arm64) triple=aarch64-linux-gnu ;;
        armhf) triple=arm-linux-gnueabihf ;;
        *) echo "depends.sh: '$architecture' has no sysroot" >&2; exit 64 ;;
    esac
    if [ ! -d "$sysroot/packages/info" ]; then
        echo "depends.sh: $sysroot keeps nothing of its packages; run 'sh toolchain/cross/sysroot.sh $architecture' again" >&2
        exit 66
    fi
    # dpkg is to find the libraries where they lie.
    cp -r "$sysroot/packages" "$work/dpkg"
    for list in "$work"/dpkg/info/*.list; do
        sed -i "s,^/,$sysroot/," "$list"
    done
    set -- --admindir="$work/dpkg" "-l$sysroot/usr/lib/$triple" "-l$sysroot/lib/$triple"
fi
(cd "$work" && DEB_HOST_ARCH=$architecture dpkg-shlibdeps -O "$@" -e"$(realpath "$program")") >"$work/depends" 2>"$work/says" || {
    cat "$work/says" >&2
    exit 70
}
sed -n 's/^shlibs:Depends=//p' "$work/depends" >"$output"
if [ ! -s "$output" ]; then
    cat "$work/says" >&2
    echo "depends.sh: dpkg-shlibdeps found no dependency of $program" >&2
    exit 70
fi
