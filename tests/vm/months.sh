#!/bin/sh
# Two hours of a board's months: dicot's package in a whole Debian with systemd, slot after slot with sleep between them, through
# kill -9, a power cut, a clock that is lost, and its own powering off. Three starts of one disk.
#
#   sh tests/vm/months.sh [FOLDER]      FOLDER: for all that it makes; .build/vm-months
#
# The machine has a clock of its own (run.sh), so that a rest of ten minutes takes none, and a busy host changes nothing.
cd "$(dirname "$0")/../.." || exit 70
name=months
. tests/vm/machine.sh

build_all package
system=$(sh tests/vm/system.sh)
cp --sparse=always "$system" "$work/disk.img"
set -- .build/arm64/dicot_*_arm64.deb
if [ $# != 1 ] || [ ! -f "$1" ]; then
    echo "months.sh: in .build/arm64 there has to be one package: $*" >&2
    exit 70
fi
package=$1

# Next year: a clock that shows a time before the program was built is held to be not set.
day=$(($(date +%Y) + 1))-06-01
failed=0
tell() { # story, time, words for run.sh
    story=$1 time=$2
    shift 2
    sh tests/vm/image.sh -o "$work/$story.cpio" --module ext4 --file "tests/vm/guest/$story.sh=/vm/story" \
        --file tests/vm/guest/tell.sh=/vm/tell --file tests/vm/guest/story.service=/vm/story.service \
        --file tests/vm/guest/months.sh=/vm/months.sh --file "$package=/vm/dicot.deb" --file tests/vm/months/rig.yaml=/vm/rig.yaml \
        --file tests/vm/months/dicot.toml=/vm/dicot.toml --file tests/vm/months/sockets.pl=/vm/sockets.pl tests/vm/guest/system.sh
    sed -n 's/^#expect *//p' "tests/vm/guest/$story.sh" | tr -s ' ' '\n' >"$work/$story.cpio.expect"
    sh tests/vm/run.sh "$work/$story.cpio" --timeout 900 --own-clock "$time" --disk "$work/disk.img" --out "$work/$story" "$@" ||
        failed=1
}
tell months_first "${day}T10:00:00" --cut 'the power may go'
tell months_second "${day}T11:42:00"
alarm=$(sed -n 's/^dicot-vm: alarm //p' "$work/months_second.cpio.log")
# The world's part: the board has power again when its alarm rings.
[ -z "$alarm" ] || tell months_third "$(date -u -d "@$alarm" +%FT%T)"
[ -n "$alarm" ] || echo "FAILED  vm months_third: no alarm was set to start it at"
exit $failed
