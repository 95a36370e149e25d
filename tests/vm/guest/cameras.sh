# Words for scripts of the virtual machine that need virtual cameras: frames from /frames/left and /frames/right, left on
# USB port 1-1, right on 1-2. To be sourced after report.sh.

commands=$PWD/commands
log=/out/camera.log
[ -p $commands ] || mkfifo $commands

start() { # words for both cameras, beginning with a comma; words for the program
    words=$1
    shift
    usbip_camera --commands $commands --camera "name=left,frames=/frames/left,serial=L1$words" \
        --camera "name=right,frames=/frames/right,serial=R1$words" "$@" >>$log 2>&1 &
    camera_pid=$!
    await 60 both_there || failed start "the cameras$words did not appear"
}
both_there() { node left >/dev/null && node right >/dev/null; }

finish() {
    echo "all now quit" >$commands
    wait $camera_pid
    await 60 none_there || failed finish "the cameras did not disappear"
}
none_there() { ! node left && ! node right; }

# Lines for the cameras; they have been obeyed when it returns.
say() {
    for line; do
        taken=$(grep -cF "command: taken: $line" $log)
        timeout 30 sh -c "echo '$line' >$commands" || return
        await 60 more_than "$taken" "command: taken: $line" || return
    done
}
more_than() { [ "$(grep -cF "$2" $log)" -gt "$1" ]; }

node() { # camera: its capture device
    case $1 in left) port=1-1 ;; right) port=1-2 ;; esac
    for video in /sys/class/video4linux/video*; do
        [ "$(cat "$video/index" 2>/dev/null)" = 0 ] || continue
        case $(readlink -f "$video/device") in
            */$port/$port:1.0)
                [ -c "/dev/${video##*/}" ] || return 1
                echo "/dev/${video##*/}"
                return 0
                ;;
        esac
    done
    return 1
}
