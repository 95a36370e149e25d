# One snapshot through each driver, before the cloud that was made of the files: runs in the virtual machine.
#expect snap.v4l2.equals_process snap.uvc.equals_process snap.missed_camera
# shellcheck source=tests/vm/guest/cameras.sh
. /vm/cameras.sh

snap() { # driver, window
    rm -rf shots
    sed "s/DRIVER/$1/; s/WINDOW/$2/" /files/dicot.toml >snap.toml
    timeout 360 dicot snap --config snap.toml -o shots --json >snap.log 2>&1
    code=$?
    cat snap.log >>"/out/snap-$1.log"
    cat snap.log
    return $code
}
equals() { # driver, window
    snap "$1" "$2" || return
    grep '"outcome": "done"' snap.log && grep '"source": "cameras"' snap.log || return
    [ "$(grep -c "\"driver\": \"$1\"" snap.log)" = 2 ] || return
    cmp shots/*/cloud.drc "/files/$1.drc"
}
start ,fps=15/5
judge snap.v4l2.equals_process equals v4l2 35
judge snap.uvc.equals_process equals uvc 11
# No cloud and no half of one, but a record that tells why.
missed() {
    say "right now unplug" && await 60 test ! -e /sys/bus/usb/devices/1-2 || return
    ! snap v4l2 11 && ls shots && ! ls shots/*/cloud.drc && grep '"outcome": "missed"' shots/*/record.json &&
        grep '"reason": ".*1-2.*"' shots/*/record.json
}
judge snap.missed_camera missed
finish
