# Computers that nobody here wrote, and dicot pull, before our gadget and before others: runs in the virtual machine.
#expect gadget.up mtp_tools.detects mtp_tools.lists mtp_tools.copies jmtpfs.equals gphoto2.lists gphoto2.copies
#expect gvfs.lists gvfs.copies gvfs.fuse_equals pull.ours pull.checks pull.again pull.qemu pull.umtp pull.two_at_once
#expect gadget.counts speed
. /vm/board.sh

store /vm/store
# mtp-tools read all devices that there are: QEMU's waits for its turn.
elsewhere() { echo "$1" >/sys/bus/usb/devices/2-1/authorized; }
await 60 test -f /sys/bus/usb/devices/2-1/product
elsewhere 0
/lib/systemd/systemd-udevd --daemon
udevadm trigger
judge gadget.up up
udevadm settle

# --- mtp-tools
detects() { mtp-detect >detect 2>&1; cat detect >/out/detect; grep 'fixed ROM' detect && grep b0a2d detect && ! grep -i error detect; }
judge mtp_tools.detects detects
lists() {
    mtp-files >files 2>&1
    cp files /out/files
    [ "$(grep -c '^File ID' files)" = "$(cd clouds/board && find . -path './[12]*' -type f ! -name PULLED | wc -l)" ]
}
judge mtp_tools.lists lists
copies() {
    mkdir -p tools
    sed -n 's/^File ID: //p' files | head -n 6 | while read -r id; do mtp-getfile "$id" "tools/$id" >/dev/null 2>&1 || exit 1; done
    sha256sum tools/* | cut -d' ' -f1 | sort >found
    # The first six are one snapshot, if handles come in their order.
    shown clouds | head -n 6 | cut -d' ' -f1 | sort | diff - found
}
judge mtp_tools.copies copies

# --- a file system
through_fuse() {
    mkdir -p m
    timeout 60 jmtpfs m >jmtpfs.log 2>&1 || { cat jmtpfs.log; return 1; }
    ls m/*/board && (cd m/*/ && shown .) >found
    shown clouds | diff - found
    result=$?
    fusermount -u m
    return $result
}
judge jmtpfs.equals through_fuse

# --- the camera's way
judge gphoto2.lists eval 'timeout 60 gphoto2 -q --list-files >camera 2>&1; cp camera /out/gphoto2; grep cloud.drc camera'
camera_copies() {
    mkdir -p shots && cd shots || return
    timeout 120 gphoto2 -q --get-all-files --force-overwrite >../camera 2>&1
    cat ../camera >>/out/gphoto2
    cd ..
    # All files of a name go to one name: the last one is left.
    ls shots && sha256sum shots/cloud.drc clouds/board/*/*/cloud.drc
    [ "$(sha256sum shots/cloud.drc clouds/board/*/*/cloud.drc | cut -d' ' -f1 | sort | uniq -d | wc -l)" -ge 1 ]
}
judge gphoto2.copies camera_copies

# --- the desktop
export XDG_RUNTIME_DIR=/run/user/0 HOME=$PWD
mkdir -p $XDG_RUNTIME_DIR
/usr/lib/aarch64-linux-gnu/glib-2.0/glib-compile-schemas /usr/share/glib-2.0/schemas
cat >desktop.sh <<'END_OF_FILE'
. /vm/report.sh
. /vm/board.sh
lists() {
    url=$(timeout 60 gio mount -li 2>/dev/null | grep -o 'mtp://[^ ]*' | head -n 1)
    echo "$url"
    timeout 60 gio mount "$url" && timeout 60 gio tree "$url" >tree
    cp tree /out/gvfs && [ "$(grep -c cloud.drc tree)" = "$(find clouds -name cloud.drc | wc -l)" ]
}
judge gvfs.lists lists
copies() {
    top=$(gio list "$url") file=$(cd clouds && echo board/*/000001*/cloud.drc)
    timeout 60 gio copy "$url$top/$file" desktop.drc && cmp desktop.drc "clouds/$file"
}
judge gvfs.copies copies
fuse_equals() {
    day=$(ls -d clouds/board/[12]* | head -n 1)
    timeout 120 diff -r /run/user/0/gvfs/*/"$top/board/${day##*/}" "$day"
}
judge gvfs.fuse_equals fuse_equals
timeout 20 gio mount -u "$url"
END_OF_FILE
timeout 300 dbus-run-session -- /bin/bash desktop.sh 2>desktop.log
cp desktop.log /out/

# --- dicot pull
ours() { pull ours --device b0a2d && same ours && [ "$(told marked)" = "$(told new)" ]; }
judge pull.ours ours
judge pull.checks dicot archive check ours
again() { pull ours --device b0a2d && same ours && [ "$(told new)" = 0 ]; }
judge pull.again again
judge gadget.counts eval 'dicot gadget status --config board.toml | tee /out/status && down'

# Those that know nothing of dicot: the standard part.
elsewhere 1
qemu() { pull qemu --device qemu0 && same qemu elsewhere; }
judge pull.qemu qemu
umtp() { other_up "$PWD/clouds" && pull umtp --device 01234567 && same umtp; }
judge pull.umtp umtp
other_down
at_once() { up && pull both && [ "$(grep -c '"exit_code": 0' pull.json)" = 2 ] && same both && same both elsewhere; }
judge pull.two_at_once at_once
down

# --- how fast: one file, one program, one machine
mkdir -p large/board/2026-06-01
cp -R /vm/store/board/2026-06-01/000001_* large/board/2026-06-01/
(
    cd large/board/2026-06-01/0* || exit
    dd if=/dev/urandom of=cloud.drc bs=1M count=16 2>/dev/null
    sha256sum ./*[!S] | sed 's,\./,,' >SHA256SUMS
)
store large
fast() { # name, least: three times, the best
    best=''
    for _ in 1 2 3; do
        trial_host speed 16 >fast || { cat fast; return 1; }
        read -r _ ms <fast
        [ -n "$best" ] && [ "$best" -le "$ms" ] || best=$ms
    done
    [ "$best" -gt 0 ]
}
speed() {
    up && fast && ours_ms=$best || { mtp-files; return 1; }
    judge_memory=$(memory_kib)
    down || return
    other_up "$PWD/clouds" && fast && others_ms=$best || { tail -n 3 /out/umtprd.log; return 1; }
    other_down
    figure "16 MiB: $ours_ms ms, umtp-responder $others_ms ms; ratio $((100 * others_ms / ours_ms)) %; the server holds $judge_memory KiB of its own"
    [ $((100 * others_ms / ours_ms)) -ge 80 ]
}
judge speed speed
