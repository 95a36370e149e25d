#!/bin/sh
# Makes the disk of a computer that people plug a board into: Debian 12 for arm64 with what reads MTP there (mtp-tools, jmtpfs,
# gphoto2, gvfs), udev, and umtp-responder, an MTP device that is not ours. No foreign architecture is added to this machine's dpkg,
# and no package script runs: what they would have done is done here.
#
#   sh tests/vm/clients.sh      prints the file: .cache/clients-arm64/disk.img, an ext4 to copy before use
#
# A disk that was made from the same recipe is used again.
set -eu

release=bookworm
packages=busybox-static,bash,coreutils,usbutils,udev,mtp-tools,jmtpfs,fuse3,gphoto2,umtp-responder,libmtp-runtime
packages=$packages,gvfs-backends,gvfs-daemons,gvfs,gvfs-fuse,libglib2.0-bin,dbus,dbus-daemon,shared-mime-info
# What dicot's package depends on.
packages=$packages,libstdc++6,libdraco7,libpng16-16,libjpeg62-turbo,libyaml-0-2,libmd0,zlib1g,libusb-1.0-0,libsqlite3-0
recipe="1 $release arm64 $packages $(cksum <"$0")"

checkout=$(cd "$(dirname "$0")/../.." && pwd)
made=$checkout/.cache/clients-arm64
if [ "$(cat "$made/recipe" 2>/dev/null)" = "$recipe" ]; then
    echo "$made/disk.img"
    exit 0
fi

PATH=$PATH:/usr/sbin:/sbin
for program in mmdebstrap mke2fs; do
    command -v $program >/dev/null && continue
    echo "clients.sh: $program is missing; install the packages mmdebstrap and e2fsprogs" >&2
    exit 69
done
# The same archive that this machine installs from.
# shellcheck disable=SC2016 # apt-get's own words in the format
mirror=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
    awk -v release="$release" '$2 == release && $3 == "main" { print $1; exit }')
if [ -z "$mirror" ]; then
    echo "clients.sh: apt knows no source for '$release main'; add one and run 'apt-get update'" >&2
    exit 69
fi

mkdir -p "$checkout/.cache"
fresh=$(mktemp -d "$checkout/.cache/clients-arm64.XXXXXX")
trap 'rm -rf "$fresh"' EXIT
root=$fresh/root
# Debian's /bin, /sbin and /lib are links since 12; the packages still name them as folders.
# shellcheck disable=SC2016 # mmdebstrap's words
if ! mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$packages" \
    --setup-hook='mkdir -p "$1/usr/bin" "$1/usr/sbin" "$1/usr/lib"; for it in bin sbin lib; do ln -s "usr/$it" "$1/$it"; done' \
    "$release" "$root" "deb $mirror $release main" >&2; then
    echo "clients.sh: cannot fetch Debian for arm64 ($packages): check the network, or run 'apt-get update'" >&2
    exit 69
fi
rm -rf "$root"/usr/share/doc "$root"/usr/share/man "$root"/usr/share/locale "$root"/usr/share/info "$root"/var/cache \
    "$root"/var/lib/apt "$root"/usr/share/icons "$root"/usr/share/gtk-doc "$root"/usr/share/fonts "$root"/usr/lib/systemd/system \
    "$root"/usr/share/perl "$root"/usr/lib/aarch64-linux-gnu/perl "$root"/usr/share/zoneinfo "$root"/usr/share/i18n

# gvfs asks these when anything looks for a device, for half a minute where they have no service to ask.
for monitor in afc goa gphoto2 udisks2; do
    rm "$root/usr/share/gvfs/remote-volume-monitors/$monitor.monitor"
done
printf '%s\n' root:x:0:0:root:/root:/bin/sh messagebus:x:100:100::/nonexistent:/bin/false \
    dicot:x:101:101::/var/lib/dicot:/bin/false >"$root/etc/passwd"
printf '%s\n' root:x:0: messagebus:x:100: dicot:x:101: plugdev:x:46: video:x:44: audio:x:29: disk:x:6: tty:x:5: input:x:104: kvm:x:105: \
    render:x:106: sgx:x:107: dialout:x:20: lp:x:7: cdrom:x:24: tape:x:26: kmem:x:15: >"$root/etc/group"
for word in ash sh mount umount mountpoint insmod awk grep sed find diff cmp xargs tar usleep killall pidof ps vi less poweroff dmesg \
    insmod sysctl mke2fs mkfifo stat truncate free setsid nohup su; do
    [ -e "$root/usr/bin/$word" ] || [ -e "$root/usr/sbin/$word" ] || ln -s busybox "$root/usr/bin/$word"
done
: >"$root/etc/machine-id"
mkdir -p "$root/vm" "$root/out"

truncate -s 768M "$fresh/disk.img"
mke2fs -q -t ext4 -d "$root" "$fresh/disk.img"
du -sh "$root" >&2
rm -rf "$root"
printf '%s\n' "$recipe" >"$fresh/recipe"
chmod 755 "$fresh"
rm -rf "$made"
mv "$fresh" "$made"
trap - EXIT
echo "$made/disk.img"
