#!/bin/sh
# Makes the disk of a whole Debian 12 for arm64: systemd, udev, dpkg with its database, what dicot's package depends on, and the
# modules of kernel.sh's kernel that such a board would load. No foreign architecture is added to this machine's dpkg, and
# no package script runs: what they would have done is done here, and written down below.
#
#   sh tests/vm/system.sh      prints the file: .cache/system-arm64/disk.img, an ext4 to copy before use
#
# A disk that was made from the same recipe is used again.
set -eu

release=bookworm
# What Debian calls essential, without a shell of its own; what boots; what dicot's package may ask for.
packages=base-files,base-passwd,bash,bsdutils,coreutils,dash,diffutils,findutils,grep,gzip,hostname,init-system-helpers,libc-bin
packages=$packages,login,mount,ncurses-bin,passwd,perl-base,sed,sysvinit-utils,tar,util-linux,dpkg,mawk
packages=$packages,systemd,systemd-sysv,udev,kmod,usr-is-merged,util-linux-extra
packages=$packages,libstdc++6,libdraco7,libpng16-16,libjpeg62-turbo,libyaml-0-2,libmd0,zlib1g,libusb-1.0-0,libsqlite3-0
modules='virtio_pci virtio_blk ext4 vivid dummy_hcd libcomposite usb_f_fs'
disk_mib=512
recipe="1 $release arm64 $packages $modules $disk_mib"

checkout=$(cd "$(dirname "$0")/../.." && pwd)
made=$checkout/.cache/system-arm64
kernel=$(sh "$checkout/tests/vm/kernel.sh")
version=$(cat "$kernel/version")
recipe="$recipe $version $(cksum <"$0")"
if [ "$(cat "$made/recipe" 2>/dev/null)" = "$recipe" ]; then
    echo "$made/disk.img"
    exit 0
fi

PATH=$PATH:/usr/sbin:/sbin
for program in mmdebstrap mke2fs depmod dpkg-deb; do
    command -v $program >/dev/null && continue
    echo "system.sh: $program is missing; install the packages mmdebstrap, e2fsprogs and kmod" >&2
    exit 69
done
# The same archive that this machine installs from.
# shellcheck disable=SC2016 # apt-get's own words in the format
mirror=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
    awk -v release="$release" '$2 == release && $3 == "main" { print $1; exit }')
if [ -z "$mirror" ]; then
    echo "system.sh: apt knows no source for '$release main'; add one and run 'apt-get update'" >&2
    exit 69
fi

fresh=$(mktemp -d "$checkout/.cache/system-arm64.XXXXXX")
trap 'rm -rf "$fresh"' EXIT
root=$fresh/root

# Debian's /bin, /sbin and /lib are links since 12; the packages still name them as folders.
# shellcheck disable=SC2016 # mmdebstrap's words
if ! mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$packages" \
    --setup-hook='mkdir -p "$1/usr/bin" "$1/usr/sbin" "$1/usr/lib"; for it in bin sbin lib; do ln -s "usr/$it" "$1/$it"; done' \
    --extract-hook='mkdir "$1/debs"; mv "$1"/var/cache/apt/archives/*.deb "$1/debs/"' \
    "$release" "$root" "deb $mirror $release main" >&2; then
    echo "system.sh: cannot fetch Debian for arm64: check the network, or run 'apt-get update'" >&2
    exit 69
fi
mv "$root/debs" "$fresh/debs"

# dpkg's database: what is installed, which files are whose, and the scripts for the day it is removed.
database=$root/var/lib/dpkg
mkdir -p "$database/info" "$database/updates" "$database/triggers"
: >"$database/available"
echo 1 >"$database/info/format"
for deb in "$fresh"/debs/*.deb; do
    dpkg-deb -f "$deb" >"$fresh/control"
    name=$(sed -n 's/^Package: //p' "$fresh/control")
    # dpkg names the files of packages that may stand beside those of other architectures so.
    ! grep -q '^Multi-Arch: same' "$fresh/control" || name=$name:arm64
    { sed 's/^\(Package: .*\)/\1\nStatus: install ok installed/' "$fresh/control"; echo; } >>"$database/status"
    dpkg-deb --fsys-tarfile "$deb" | tar -t | sed 's,^\.,,; s,/$,,; s,^$,/.,' >"$database/info/$name.list"
    mkdir "$fresh/words"
    dpkg-deb -e "$deb" "$fresh/words"
    for word in preinst postinst prerm postrm conffiles triggers md5sums; do
        [ ! -f "$fresh/words/$word" ] || mv "$fresh/words/$word" "$database/info/$name.$word"
    done
    # Whom a file below a folder, or another package's word, is of interest to: without it dpkg takes all for just triggered.
    sed -n 's,^interest\(-await\)* *\(/.*\),\2 ,p; s,^interest-noawait *\(/.*\),\1 /noawait,p' "$database/info/$name.triggers" 2>/dev/null |
        while read -r path how; do echo "$path $name${how:-}"; done >>"$database/triggers/File"
    sed -n 's,^interest\(-await\)* *\([^/]*\)$,\2 ,p; s,^interest-noawait *\([^/]*\)$,\1 /noawait,p' "$database/info/$name.triggers" 2>/dev/null |
        while read -r word how; do echo "$name${how:-}" >>"$database/triggers/$word"; done
    rm -rf "$fresh/words"
done
: >"$database/triggers/Unincorp"

# What the packages' scripts would have done: accounts, the machine's name, a shell, the libraries' index.
for file in passwd group; do cp "$root/usr/share/base-passwd/$file.master" "$root/etc/$file"; done
sed 's/^\([^:]*\):.*/\1:*:19000:0:99999:7:::/' "$root/etc/passwd" >"$root/etc/shadow"
sed 's/^\([^:]*\):.*/\1:*::/' "$root/etc/group" >"$root/etc/gshadow"
chmod 640 "$root/etc/shadow" "$root/etc/gshadow"
[ -e "$root/bin/sh" ] || ln -s dash "$root/bin/sh"
ln -sf mawk "$root/usr/bin/awk"
echo board >"$root/etc/hostname"
: >"$root/etc/machine-id"
rm -f "$root/etc/resolv.conf" "$root"/etc/apt/sources.list

# What boots without it, and takes seconds under emulation.
for unit in systemd-networkd.service systemd-resolved.service systemd-timesyncd.service systemd-hwdb-update.service \
    systemd-firstboot.service systemd-machine-id-commit.service ldconfig.service systemd-update-utmp.service \
    systemd-update-utmp-runlevel.service systemd-pcrphase.service systemd-pcrphase-sysinit.service systemd-logind.service \
    systemd-binfmt.service proc-sys-fs-binfmt_misc.automount getty.target apt-daily.timer apt-daily-upgrade.timer \
    dpkg-db-backup.timer fstrim.timer e2scrub_all.timer systemd-tmpfiles-clean.timer systemd-pstore.service \
    modprobe@configfs.service modprobe@dm_mod.service modprobe@drm.service modprobe@efi_pstore.service \
    modprobe@fuse.service modprobe@loop.service; do
    ln -sf /dev/null "$root/etc/systemd/system/$unit"
done
mkdir -p "$root/etc/systemd/system.conf.d" "$root/var/log/journal"
printf '/dev/root / ext4 defaults 0 0\n' >"$root/etc/fstab"
rm -rf "$root"/usr/share/doc "$root"/usr/share/man "$root"/usr/share/locale "$root"/usr/share/info "$root"/var/cache/apt \
    "$root"/var/lib/apt/lists

# The modules, with all that they depend on, and kmod's index of them.
for module in $modules; do
    modprobe -d "$kernel" -S "$version" --show-depends "$module" | while read -r word path _; do
        [ "$word" = insmod ] || continue
        folder=$root/usr/lib/modules/$version/$(dirname "${path#*/lib/modules/"$version"/}")
        mkdir -p "$folder"
        cp "$path" "$folder/"
    done
done
cp "$kernel/lib/modules/$version"/modules.builtin* "$kernel/lib/modules/$version/modules.order" "$root/usr/lib/modules/$version/"
depmod -b "$root" "$version"
echo vivid >"$root/etc/modules-load.d/cameras.conf"
echo 'options vivid n_devs=2 node_types=0x1,0x1 input_types=0x0,0x0' >"$root/etc/modprobe.d/cameras.conf"

truncate -s ${disk_mib}M "$fresh/disk.img"
mke2fs -q -t ext4 -d "$root" "$fresh/disk.img"
rm -rf "$root" "$fresh/debs" "$fresh/control"
printf '%s\n' "$recipe" >"$fresh/recipe"
chmod 755 "$fresh"
rm -rf "$made"
mv "$fresh" "$made"
trap - EXIT
echo "$made/disk.img"
