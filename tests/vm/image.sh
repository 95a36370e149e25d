#!/bin/sh
# Packs what one run of the virtual machine needs into an initramfs.
#
#   sh tests/vm/image.sh -o IMAGE [--module NAME] [--program FILE] [--file FROM=TO] ... SCRIPT
#
# SCRIPT     runs in the machine, with the words of tests/vm/guest/report.sh. Each of its lines that begin with `#expect`
#            names tests that have to report; run.sh finds them in IMAGE.expect.
# --module   a kernel module, with all that it depends on; loaded in this order before SCRIPT. Always there: virtio_blk,
#            virtio_pci (for what the machine hands out).
# --program  an arm64 program, to be found in the machine's PATH, with the shared libraries that it needs, taken from the
#            kernel's tree or .cache/sysroot-arm64.
# --file     a file or folder for the machine.
#
# The image is a plain cpio: unpacking a compressed one under emulation takes longer than reading this one.
set -eu

here=$(cd "$(dirname "$0")" && pwd)
checkout=$(cd "$here/../.." && pwd)
image='' modules='virtio_pci virtio_blk' programs='' files=''
newline='
'
while [ $# -gt 1 ]; do
    case $1 in
        -o) image=$2 ;;
        --module) modules="$modules $2" ;;
        --program) programs="$programs$2$newline" ;;
        --file) files="$files$2$newline" ;;
        *) echo "image.sh: '$1' is no option; see its first lines" >&2; exit 64 ;;
    esac
    shift 2
done
script=${1:-}
if [ -z "$image" ] || [ ! -f "$script" ]; then
    echo "image.sh: say -o IMAGE, and a SCRIPT that is there" >&2
    exit 64
fi
for program in cpio modprobe readelf; do
    command -v $program >/dev/null && continue
    echo "image.sh: $program is missing; install the packages cpio, kmod and binutils" >&2
    exit 69
done

tree=$(sh "$here/kernel.sh")
version=$(cat "$tree/version")
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
mkdir -p "$root/bin" "$root/dev" "$root/proc" "$root/sys" "$root/tmp" "$root/out" "$root/lib" "$root/vm/modules"
cp "$tree/bin/busybox" "$root/bin/busybox"
cp "$here/guest/init" "$root/init"
cp "$here/guest/report.sh" "$root/vm/report.sh"
cp "$script" "$root/vm/script"
chmod 755 "$root/init"

# In the order in which they can be loaded; a name that the kernel does not have stops here.
for module in $modules; do
    modprobe -d "$tree" -S "$version" --show-depends "$module" >"$root/depends"
    while read -r word path _; do
        name=${path##*/}
        [ "$word" = insmod ] && [ ! -f "$root/vm/modules/$name" ] || continue
        cp "$path" "$root/vm/modules/$name"
        echo "$name" >>"$root/vm/order"
    done <"$root/depends"
done
rm -f "$root/depends"

library() { # name: where it is
    for sysroot in "$tree" "$checkout/.cache/sysroot-arm64"; do
        for folder in lib/aarch64-linux-gnu usr/lib/aarch64-linux-gnu lib; do
            [ ! -f "$sysroot/$folder/$1" ] || { echo "$sysroot/$folder/$1"; return 0; }
        done
    done
    echo "image.sh: no library $1 for arm64 is at hand; it is in no tree of .cache" >&2
    return 69
}

take_libraries() { # program or library
    for name in $(readelf -d -l "$1" 2>/dev/null |
        sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p; s,.*interpreter: /lib/\(.*\)\].*,\1,p'); do
        [ ! -f "$root/lib/$name" ] || continue
        found=$(library "$name")
        cp -L "$found" "$root/lib/$name"
        take_libraries "$root/lib/$name"
    done
}

printf '%s' "$programs" >"$root/list"
while read -r program; do
    cp "$program" "$root/bin/"
    take_libraries "$program"
done <"$root/list"
printf '%s' "$files" >"$root/list"
while read -r pair; do
    mkdir -p "$(dirname "$root/${pair#*=}")"
    cp -RL "${pair%%=*}" "$root/${pair#*=}"
done <"$root/list"
rm -f "$root/list"

mkdir -p "$(dirname "$image")"
(cd "$root" && find . | LC_ALL=C sort | cpio --quiet -o -H newc -R 0:0 --reproducible) >"$image.part"
sed -n 's/^#expect *//p' "$script" | tr -s ' ' '\n' | sed '/^$/d' >"$image.expect"
mv "$image.part" "$image"
