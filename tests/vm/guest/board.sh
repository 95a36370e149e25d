# A board and a computer in one machine, and the cable between them (dummy_hcd): to be sourced by stories that clients.sh tells.
# The board's store is clouds, its device "board"; the computer is bus 1.
gadgets=/sys/kernel/config/usb_gadget
export SYSTEMD_IGNORE_CHROOT=1

# Seen, although what a judged command prints is not.
exec 4>&1
figure() { echo "dicot-vm: figure $*" >&4; }

# --- the board
store() { # folder to be copied: complete snapshots
    rm -rf clouds
    cp -R "$1" clouds && chown -R dicot:dicot clouds
}
cat >board.toml <<END_OF_FILE
[output]
device = "board"
folder = "$PWD/clouds"
[usb]
serial = "b0a2d"
END_OF_FILE
up() { # words for dicot gadget up
    dicot gadget up --config board.toml "$@" >>/out/gadget.log 2>&1 &
    board=$!
    await 20 plugged_in || { tail -n 5 /out/gadget.log; return 1; }
}
down() {
    dicot gadget down --config board.toml
    result=$?
    wait "$board"
    return $result
}
plugged_in() { grep -qs configured /sys/class/udc/dummy_udc.0/state && lsusb | grep -q 1d6b:0100; }
unplug() { echo >"$gadgets/${1:-dicot}/UDC"; }
# The board plugs itself in again, too, after some seconds.
plug() { echo dummy_udc.0 >"$gadgets/${1:-dicot}/UDC" 2>/dev/null; await 20 plugged_in; }
# The process of dicot that was told so.
told_to() { # words
    for pid in $(pidof dicot); do
        ! tr '\0' ' ' <"/proc/$pid/cmdline" | grep -q "^[^ ]*dicot $1" || echo "$pid"
    done | sort -n | tail -n 1
}
serving() { told_to 'gadget up'; }
memory_kib() { awk '/^Private_Dirty:/ { print $2 }' "/proc/$(serving)/smaps_rollup"; }
# The store as others see it: what is complete, but for the board's own note of who has it.
shown() { # store, its device if not "board"
    (cd "$1/${2:-board}" && find . -path './[12]*' -type f ! -name PULLED -exec sha256sum '{}' + | sort -k 2)
}

# --- another device: umtp-responder with a folder of its own
other_up() { # folder
    mkdir -p "$gadgets/other/strings/0x409" "$gadgets/other/configs/c.1/strings/0x409" "$gadgets/other/functions/ffs.other" /dev/ffs-mtp
    (
        cd "$gadgets/other" || exit
        echo 0x1d6b >idVendor
        echo 0x0100 >idProduct
        echo 01234567 >strings/0x409/serialnumber
        echo others >strings/0x409/manufacturer
        echo responder >strings/0x409/product
        [ -e configs/c.1/ffs.other ] || ln -s functions/ffs.other configs/c.1/
    )
    grep -q " /dev/ffs-mtp " /proc/mounts || mount -t functionfs other /dev/ffs-mtp || return
    sed "s,^storage.*,storage \"$1\" \"other\" \"ro\"," /etc/umtprd/umtprd.conf >umtprd.conf
    umtprd -conf "$PWD/umtprd.conf" >>/out/umtprd.log 2>&1 &
    other=$!
    sleep 1
    plug other
}
other_down() {
    unplug other
    kill "$other"
    wait "$other" 2>/dev/null
    return 0
}

# --- the computer
same() { # archive, device if not "board": has the store's complete snapshots, and nothing else in their place
    shown clouds >wanted && shown "$1" "${2:-board}" >found && diff wanted found && [ -s wanted ] &&
        (cd "$1/${2:-board}" && find . -name SHA256SUMS -path './[12]*' | while read -r sums; do
            (cd "$(dirname "$sums")" && sha256sum --quiet -c SHA256SUMS) || exit 1
        done)
}
# Whole or not there: each folder in its place has what its sums name.
nothing_half() { # archive
    [ -d "$1/board" ] || return 0
    (cd "$1/board" && find . -mindepth 2 -maxdepth 2 -path './[12]*' -type d | while read -r folder; do
        (cd "$folder" && sha256sum --quiet -c SHA256SUMS) || exit 1
    done)
}
told() { # key: of the last pull --json
    sed -n "s/.*\"$1\": *\"\{0,1\}\([^\",]*\).*/\1/p" pull.json | head -n 1
}
# All: what another archive has had already, too.
pull() { # archive, words
    archive=$1
    shift
    timeout 300 dicot pull "$archive" --all --json "$@" >pull.json 2>pull.log
    code=$?
    cat pull.json pull.log >>/out/pull.log
    [ $code = 0 ] || cat pull.json pull.log
    return $code
}
