# One snapshot through each driver, beside the cloud that was made of the files: runs in the virtual machine.
#expect snap.v4l2.equals_process snap.uvc.equals_process snap.uvc.sealed snap.store snap.missed_camera
# shellcheck source=tests/vm/guest/cameras.sh
. /vm/cameras.sh

snap() { # driver, window
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
    [ "$(grep -c "\"driver\": \"$1\"" snap.log)" = 3 ] || return # both cameras', and the configuration's
    dicot export "shots/board/$(folder)/cloud.drc" -o cloud.ply || return
    sh /vm/points.sh cloud.ply | cmp - "/files/$1.points"
}
folder() { # of the newest slot
    dicot list --store shots --last 1 --json | sed -n 's/.*"folder": *"\([^"]*\)".*/\1/p'
}
start ,fps=15/5
judge snap.v4l2.equals_process equals v4l2 35
judge snap.uvc.equals_process equals uvc 11
# libusb and libudev behind the sealed heap: anything that asks for memory outside of the arenas ends the program.
sealed() {
    sed "s/DRIVER/uvc/; s/WINDOW/3/" /files/dicot.toml >run.toml
    timeout 240 dicot run --once --config run.toml -o sealed && dicot list --store sealed --json | grep '"outcome":"done"'
}
judge snap.uvc.sealed sealed
stored() {
    dicot verify --store shots && dicot show 2 --store shots && [ "$(echo shots/board/*/*/cloud.drc | wc -w)" = 2 ]
}
judge snap.store stored
# No cloud and no half of one, but a record that tells why.
missed() {
    say "right now unplug" && await 60 test ! -e /sys/bus/usb/devices/1-2 || return
    ! snap v4l2 11 && at=shots/board/$(folder) && ls "$at" && [ ! -e "$at/cloud.drc" ] &&
        grep '"outcome": "missed"' "$at/record.json" && grep '"reason": ".*1-2.*"' "$at/record.json"
}
judge snap.missed_camera missed
finish
