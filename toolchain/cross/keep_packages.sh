#!/bin/sh
# What dpkg-shlibdeps asks of packages: their lists of files and what their libraries demand, as a folder of dpkg's own
# form, ROOT/packages. A hook of mmdebstrap, which deletes the packages afterwards.
#
#   keep_packages.sh ROOT
set -eu
root=$1
kept=$root/packages
mkdir -p "$kept/info" "$kept/updates"
echo 1 >"$kept/info/format" # files are named for package and architecture
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for package in "$root"/var/cache/apt/archives/*.deb; do
    dpkg-deb -e "$package" "$work/control"
    if [ -e "$work/control/shlibs" ] || [ -e "$work/control/symbols" ]; then
        name=$(dpkg-deb -f "$package" Package)
        [ "$(dpkg-deb -f "$package" Multi-Arch)" != same ] || name=$name:$(dpkg-deb -f "$package" Architecture)
        for asked in shlibs symbols; do
            [ ! -e "$work/control/$asked" ] || cp "$work/control/$asked" "$kept/info/$name.$asked"
        done
        dpkg-deb --fsys-tarfile "$package" | tar -t | sed -e 's,^\.,,' -e 's,\(.\)/$,\1,' >"$kept/info/$name.list"
        sed -e '1a Status: install ok installed' "$work/control/control" >>"$kept/status"
        echo >>"$kept/status"
    fi
    rm -rf "$work/control"
done
# Whose packages dpkg is to believe in: this machine's kind and the other one's.
printf '%s\n' all "$(dpkg --print-architecture)" "$(sed -n 's/^Architecture: //p' "$kept/status" | sort -u | grep -vx all)" |
    sort -u >"$kept/arch"
