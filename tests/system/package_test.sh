#!/bin/sh
# One Debian package of dicot, held against what a board is promised; its program is run. Prints "ok" and "FAILED" lines.
#
#   package_test.sh DEB ARCHITECTURE [EMULATOR]     a command line, such as "qemu-arm -L SYSROOT"
set -eu
LC_ALL=C
export LC_ALL
deb=${1:?package_test.sh: name a package}
arch=${2:?package_test.sh: name its architecture}
checkout=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

judge() { # what, exit code of the check
    if [ "$2" = 0 ]; then
        echo "ok      $arch package: $1"
    else
        echo "FAILED  $arch package: $1"
        failed=1
    fi
}
same() { # what, expected, found
    if [ "$2" = "$3" ]; then
        judge "$1" 0
    else
        judge "$1" 1
        printf '%s\n' "$2" >"$work/expected"
        printf '%s\n' "$3" >"$work/found"
        diff "$work/expected" "$work/found" | sed 's/^/          /'
    fi
}
field() { dpkg-deb -f "$deb" "$1"; }

dpkg-deb -R "$deb" "$work/root"
root=$work/root
program=$root/usr/bin/dicot
emulator=${3:-}
dicot() { $emulator "$program" "$@"; }

same "name and architecture" "dicot $arch" "$(field Package) $(field Architecture)"
same "version is the program's" "$(dicot --version)" "dicot $(field Version)"
same "version is the changelog's" "$(field Version)" \
    "$(gzip -dc "$root/usr/share/doc/dicot/changelog.gz" | sed -n '1s/^dicot (\(.*\)) .*/\1/p')"
same "every field is filled" "" "$(for name in Maintainer Description Section Priority Installed-Size; do
    [ -n "$(field $name)" ] || echo "$name"
done)"

# Debian's own names for the libraries, as packages.debian.org has them.
package_of() {
    case $1 in
        libc.so.6 | libm.so.6 | ld-linux*) echo libc6 ;;
        libgcc_s.so.1) echo libgcc-s1 ;;
        libstdc++.so.6) echo libstdc++6 ;;
        libyaml-0.so.2) echo libyaml-0-2 ;;
        libsqlite3.so.0) echo libsqlite3-0 ;;
        libusb-1.0.so.0) echo libusb-1.0-0 ;;
        libmd.so.0) echo libmd0 ;;
        libpng16.so.16) echo libpng16-16 ;;
        libjpeg.so.62) echo libjpeg62-turbo ;;
        libz.so.1) echo zlib1g ;;
        *) echo "unknown:$1" ;;
    esac
}
needed=$(readelf -d "$program" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
judge "the program names its libraries" "$([ -n "$needed" ]; echo $?)"
same "each library has its package in Depends, and nothing else is there but the system" \
    "$({ for library in $needed; do package_of "$library"; done; printf '%s\n' systemd udev; } | sort -u)" \
    "$(field Depends | tr , '\n' | sed -e 's/^ *//' -e 's/ .*//' | sort -u)"
same "libc and libstdc++ are asked for in a version" "2" \
    "$(field Depends | grep -oE '(libc6|libstdc\+\+6) \(>= [0-9]' | wc -l)"

same "the configuration alone is a conffile" /etc/dicot/dicot.toml "$(cat "$root/DEBIAN/conffiles")"
same "files, modes and owners" "-rw-r--r-- root/root ./etc/dicot/dicot.toml
-rw-r--r-- root/root ./lib/systemd/system/dicot-clock.path
-rw-r--r-- root/root ./lib/systemd/system/dicot-clock.service
-rw-r--r-- root/root ./lib/systemd/system/dicot-gadget.service
-rw-r--r-- root/root ./lib/systemd/system/dicot-power-off.path
-rw-r--r-- root/root ./lib/systemd/system/dicot-power-off.service
-rw-r--r-- root/root ./lib/systemd/system/dicot.service
-rw-r--r-- root/root ./lib/udev/rules.d/60-dicot.rules
-rw-r--r-- root/root ./lib/udev/rules.d/61-dicot-computer.rules
-rw-r--r-- root/root ./usr/lib/sysusers.d/dicot.conf
-rw-r--r-- root/root ./usr/lib/tmpfiles.d/dicot.conf
-rw-r--r-- root/root ./usr/share/bash-completion/completions/dicot
-rw-r--r-- root/root ./usr/share/doc/dicot/README.Debian
-rw-r--r-- root/root ./usr/share/doc/dicot/changelog.gz
-rw-r--r-- root/root ./usr/share/doc/dicot/copyright
-rw-r--r-- root/root ./usr/share/man/man1/dicot.1.gz
-rwxr-xr-x root/root ./usr/bin/dicot" "$(dpkg-deb -c "$deb" | grep -v '^d' | awk '{ print $1, $2, $6 }' | sort)"
same "folders are root's and written by root alone" "" "$(dpkg-deb -c "$deb" | grep '^d' | grep -v '^drwxr-xr-x root/root ' || true)"
judge "checksums hold" "$(cd "$root" && md5sum --quiet -c DEBIAN/md5sums >&2; echo $?)"
same "scripts can be run, and are sh" "" "$(for script in postinst prerm postrm; do
    { [ -x "$root/DEBIAN/$script" ] && sh -n "$root/DEBIAN/$script"; } || echo "$script"
done)"

case $arch in
    amd64) machine='Advanced Micro Devices X86-64' ;;
    arm64) machine=AArch64 ;;
    armhf) machine=ARM ;;
esac
same "machine" "$machine" "$(readelf -h "$program" | sed -n 's/^ *Machine: *//p')"
same "stripped" "" "$(readelf -SW "$program" | grep -oE '\.(symtab|debug_[a-z]+)' || true)"
size=$(wc -c <"$program")
echo "        $arch: dicot has $size bytes, the package $(wc -c <"$deb")"
judge "the program has 6 MB at most" "$([ "$size" -le 6000000 ]; echo $?)"

same "what a board needs is configured, and nothing else" 'output.folder "/var/lib/dicot/clouds"' \
    "$(dicot config --config "$root/etc/dicot/dicot.toml" --json | python3 -c '
import json, sys
for section, keys in sorted(json.load(sys.stdin)["sections"].items()):
    for key, said in sorted(keys.items()):
        if said["from"] != "default":
            print(section + "." + key, json.dumps(said["value"]))')"

# Names that must agree between files.
unit=$root/lib/systemd/system/dicot.service
same "the service is the user that sysusers makes" "$(sed -n 's/^User=//p' "$unit")" \
    "$(sed -n 's/^u \([a-z]*\) .*/\1/p' "$root/usr/lib/sysusers.d/dicot.conf")"
same "nothing is for everybody" "" "$(grep -nE 'MODE="[0-7]*[1-7]"' "$root"/lib/udev/rules.d/*.rules || true)"
request=$(sed -n 's/^PathExists=//p' "$root/lib/systemd/system/dicot-power-off.path")
judge "the request to power off is the one that the program makes" \
    "$(grep -rqF "\"$request\"" "$checkout/platform/app/power"; echo $?)"

offer=$(sed -n 's/^PathExists=//p' "$root/lib/systemd/system/dicot-clock.path")
judge "the offer of a time is the one that the program makes" "$(grep -rqF "\"$offer\"" "$checkout/platform/app/usb"; echo $?)"
rule=$(grep -v '^#' "$root/lib/udev/rules.d/61-dicot-computer.rules")
device=$checkout/drivers/usb/gadget/include/dicot/gadget/usb_gadget.h
for word in kVendor:idVendor kProduct:idProduct kManufacturer:manufacturer; do
    value=$(sed -n "s/.*${word%:*} = \(0x\|\"\)\([a-z0-9]*\)\"*;.*/\2/p" "$device")
    judge "the computer's rule is for our ${word#*:}" \
        "$([ -n "$value" ] && echo "$rule" | grep -qF "ATTR{${word#*:}}==\"$value\""; echo $?)"
done

if command -v systemd-analyze >/dev/null; then
    mkdir -p "$root/bin" "$root/etc/systemd/system"
    # Programs and pages of the machine itself are not in this root.
    for unit in dicot.service dicot-power-off.path dicot-power-off.service dicot-clock.path dicot-clock.service dicot-gadget.service; do
        sed -e '/^Documentation=/d' -e 's,^\(ExecStart[a-zA-Z]*\)=.*,\1=/bin/true,' "$root/lib/systemd/system/$unit" \
            >"$work/$unit"
    done
    same "systemd understands the units" "" \
        "$(systemd-analyze verify "$work/dicot.service" "$work/dicot-power-off.path" "$work/dicot-power-off.service" \
            "$work/dicot-clock.path" "$work/dicot-clock.service" "$work/dicot-gadget.service" 2>&1 |
            grep -F dicot || true)"
    exposure=$(systemd-analyze security --offline=true "$work/dicot.service" |
        sed -n 's/.*exposure level for dicot.service: \([0-9]*\)\.\([0-9]\).*/\1\2/p')
    echo "        $arch: systemd-analyze security: ${exposure%?}.${exposure#"${exposure%?}"}"
    judge "exposure is 2.0 at most" "$([ "${exposure:-99}" -le 20 ]; echo $?)"
else
    echo "NOT RUN: systemd-analyze is not installed: nobody else reads the units"
fi

if command -v man >/dev/null; then
    gzip -dc "$root/usr/share/man/man1/dicot.1.gz" >"$work/dicot.1"
    same "the page is set without a warning" "" "$(man --warnings -l -Tutf8 "$work/dicot.1" 2>&1 >/dev/null)"
else
    echo "NOT RUN: man is not installed: nobody sets the page"
fi
exit $failed
