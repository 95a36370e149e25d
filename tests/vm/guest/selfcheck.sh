# The virtual cameras before the kernel's own driver: runs in the virtual machine, judged by v4l2-ctl and cmp.
#expect iso.yuyv.left iso.yuyv.right iso.mjpeg.left iso.mjpeg.right iso.large iso.smallest_setting iso.largest_setting
#expect bulk.yuyv.left bulk.yuyv.right bulk.mjpeg.left bulk.mjpeg.right bulk.short bulk.drop
#expect bulk.payload_of_several_transfers
#expect control.set_and_read control.held_by_automatism control.out_of_range control.stall control.short_reply control.mute
#expect bus.second_camera_gets_enospc bus.small_settings_fit fault.refuse_interface
#expect fault.short fault.drop fault.bad_header fault.err fault.wrong_fid fault.truncate.yuyv fault.truncate.mjpeg
#expect fault.zero_frame fault.no_eof fault.overlong fault.late fault.silent fault.hang
#expect fault.unplug fault.comes_back fault.cut_descriptors fault.product now.unplug now.plug
# shellcheck source=tests/vm/guest/cameras.sh
. /vm/cameras.sh

# Damaged frames are handed over with their flag; the driver's default is to keep them to itself.
echo 1 >/sys/module/uvcvideo/parameters/nodrop

# Takes frames into <camera>.raw; what v4l2-ctl says about each goes to <camera>.log.
take() { # camera, YUYV or MJPG, size, fps, count
    device=$(node "$1") || return
    timeout 60 v4l2-ctl -d "$device" --set-fmt-video="width=${3%x*},height=${3#*x},pixelformat=$2" --set-parm="$4" \
        --stream-mmap --stream-count="$5" --stream-to="$1.raw" --verbose >"$1.log" 2>&1
}

# One line a frame: sequence number, bytes, "error" or "whole".
frames_of() { # camera
    sed -n 's/^cap dqbuf: *[0-9]* seq: *\([0-9]*\) bytesused: *\([0-9]*\) \(.*\)/\1 \2 \3/p' "$1.log" |
        sed 's/^\([0-9]* [0-9]*\) .*error.*/\1 error/;t;s/^\([0-9]* [0-9]*\) .*/\1 whole/'
}

# Every frame is byte for byte the file that its number names.
all_equal() { # camera, size, ending, frames that there have to be
    frames_of "$1"
    [ "$(frames_of "$1" | grep -c whole)" = "$4" ] || { cat "$1.log"; return 1; }
    files=$(ls "/frames/$1/$2"_*."$3" | wc -l)
    frames_of "$1" | while read -r sequence _; do
        cat "/frames/$1/$2_$((sequence % files)).$3"
    done | cmp - "$1.raw"
}

both() { # name, v4l2's format, ending
    take left "$2" 640x480 5 5 &
    other=$!
    take right "$2" 640x480 5 5
    wait $other
    judge "$1.left" all_equal left 640x480 "$3" 5
    judge "$1.right" all_equal right 640x480 "$3" 5
}

# A stream whose frame 2 goes wrong, and the lines that it is to leave in frames_of. A line that begins with "no" must not
# be there.
spoiled() { # fault, format, lines
    say "left next 2 $1" || return
    take left "$2" 640x480 15 5 || return
    frames_of left >frames
    cat frames
    awk -v word="${1%% *}" '/^left: stream .* starts/ { seen = 0 } $0 ~ " frame 2: " word { seen = 1 }
        END { exit !seen }' $log || { echo "the camera did not do it"; return 1; }
    shift 2
    for line; do
        case $line in
            no*) ! grep -qx "${line#no }" frames || { echo "is there: $line"; return 1; } ;;
            *) grep -qx "$line" frames || { echo "is not there: $line"; return 1; } ;;
        esac
    done
}
yuyv='614400'

# --- isochronous, 1600 bytes a microframe at 15 fps: 1588 of picture

start ,fps=30/15/5
both iso.yuyv YUYV yuyv
both iso.mjpeg MJPG jpg
take left YUYV 1280x720 5 3
judge iso.large all_equal left 1280x720 yuyv 3

judge fault.short spoiled "short packet=3 bytes=100" YUYV "1 $yuyv whole" "2 $((yuyv - 100)) error" "3 $yuyv whole"
judge fault.drop spoiled "drop packet=3" YUYV "1 $yuyv whole" "2 $((yuyv - 1588)) error" "3 $yuyv whole"
judge fault.bad_header spoiled "bad_header packet=3 length=0" YUYV "2 $((yuyv - 1588)) error" "3 $yuyv whole"
judge fault.err spoiled "err packet=3" YUYV "1 $yuyv whole" "2 $yuyv error" "3 $yuyv whole"
judge fault.wrong_fid spoiled "wrong_fid packet=3" YUYV "1 $yuyv whole" "2 $((3 * 1588)) error"
judge fault.truncate.yuyv spoiled "truncate byte=5000" YUYV "1 $yuyv whole" "2 5000 error" "3 $yuyv whole"
judge fault.truncate.mjpeg spoiled "truncate byte=5000" MJPG "2 5000 whole"
# The driver puts the next picture into the buffer that it had begun, and counts on.
judge fault.zero_frame spoiled zero_frame YUYV "2 $yuyv whole" "no 3 .*" "4 $yuyv whole"
judge fault.no_eof spoiled no_eof YUYV "2 $yuyv whole" "no 3 .*" "4 $yuyv whole"
judge fault.overlong spoiled overlong YUYV "2 $yuyv error" "3 $yuyv whole"
late_frame() {
    spoiled "late ms=3000" YUYV "2 $yuyv whole" &&
        sed -n 's/.* seq: *2 .*delta: *\([0-9]*\).*/\1/p' left.log >delta_ms && [ "$(cat delta_ms)" -gt 1500 ]
}
judge fault.late late_frame

gets() { # frames, of four that are asked for
    timeout 120 v4l2-ctl -d "$(node left)" --stream-mmap --stream-count=4 --verbose >left.log 2>&1 &
    reader=$!
    await 60 came "$1"
    sleep 2 # for one too many
    kill $reader
    wait $reader
    frames_of left >frames
    [ "$(wc -l <frames)" = "$1" ]
}
came() { [ "$(frames_of left | wc -l)" -ge "$1" ]; }
judge fault.silent eval 'say "left next 2 silent" && gets 2 && gets 4'
# The configuration is set anew, as after a reset of the port.
configured_anew() {
    echo 0 >/sys/bus/usb/devices/1-1/authorized && echo 1 >/sys/bus/usb/devices/1-1/authorized && await 60 node left
}
judge fault.hang eval 'say "left next 2 hang" && gets 2 && gets 0 && configured_anew && gets 4'

# --- controls

set_control() { v4l2-ctl -d "$(node left)" --set-ctrl "$1"; }
control_is() { [ "$(v4l2-ctl -d "$(node left)" --get-ctrl "${1%=*}")" = "${1%=*}: ${1#*=}" ]; }
judge control.set_and_read eval 'set_control brightness=-7 && control_is brightness=-7 && grep "^left: brightness set" $log'
held() {
    ! set_control exposure_time_absolute=100 && set_control auto_exposure=1 && set_control exposure_time_absolute=100 &&
        control_is exposure_time_absolute=100
}
judge control.held_by_automatism held
# v4l2 itself clamps; past it, straight to the camera: contrast 256 of 0 .. 255.
judge control.out_of_range eval 'set_control contrast=300 && control_is contrast=255'
judge control.stall eval 'say "left control stall unit=2 selector=2 request=set_cur" && ! set_control brightness=4 &&
    set_control brightness=5 && control_is brightness=5'
short_reply() {
    say "left control short_reply unit=2 selector=4 request=get_cur bytes=1" || return
    v4l2-ctl -d "$(node left)" --get-ctrl gain
    dmesg | grep 'UVC control 4 on unit 2: 1 (exp. 2)'
}
judge control.short_reply short_reply
judge control.mute eval 'say "left control mute unit=2 selector=2 request=set_cur" &&
    set_control brightness=6 2>&1 | grep "timed out" && set_control brightness=6'
refused() {
    say "left control refuse_interface errno=32" || return
    v4l2-ctl -d "$(node left)" --stream-mmap --stream-count=1 2>&1 | grep 'STREAMON returned -1 (Broken pipe)' &&
        take left YUYV 640x480 15 1
}
judge fault.refuse_interface refused

# --- the cable

unplugged() {
    say "left next 2 unplug byte=5000 back_ms=700" || return
    take left YUYV 640x480 15 5
    frames_of left >frames
    cat frames
    [ "$(wc -l <frames)" = 2 ] && ! node left && node right
}
judge fault.unplug unplugged
judge fault.comes_back eval 'await 60 node left && take left YUYV 640x480 15 2 && all_equal left 640x480 yuyv 2'
gone() { ! node left; }
judge now.unplug eval 'say "left now unplug" && await 60 gone'
cut_descriptors() {
    say "left plug cut_descriptors byte=100" "left now plug" && await 60 test -f /sys/bus/usb/devices/1-1/product &&
        dmesg | grep 'usb 1-1: config index 0 descriptor too short (expected 412, got 100)'
}
judge fault.cut_descriptors cut_descriptors
product() {
    say "left now unplug" && await 60 gone && await 60 test ! -e /sys/bus/usb/devices/1-1 && say "left now forget" \
        'left plug product text=\x1b[31mred\sone' "left now plug" && await 60 test -f /sys/bus/usb/devices/1-1/product &&
        [ "$(cat /sys/bus/usb/devices/1-1/product)" = "$(printf '\033[31mred one')" ]
}
judge fault.product product
judge now.plug await 60 both_there
finish

# --- bulk, 16384 bytes a payload: 16372 of picture

start ,fps=30/15/5,transfer=bulk
both bulk.yuyv YUYV yuyv
both bulk.mjpeg MJPG jpg
judge bulk.short spoiled "short packet=3 bytes=100" YUYV "2 $((yuyv - 100)) error" "3 $yuyv whole"
judge bulk.drop spoiled "drop packet=3" YUYV "2 $((yuyv - 16372)) error" "3 $yuyv whole"
finish
start ,transfer=bulk,payload=40000
take left YUYV 640x480 5 2
judge bulk.payload_of_several_transfers all_equal left 640x480 yuyv 2
finish

# --- two cameras on one bus, which could reserve 6000 bytes a microframe

start ,payload=most --bus-bytes 6000
take left YUYV 640x480 5 2
judge iso.largest_setting eval 'all_equal left 640x480 yuyv 2 && grep "starts: .* 3072 bytes a microframe" $log'
v4l2-ctl -d "$(node left)" --set-parm=5 --stream-mmap --stream-count=1000 >/dev/null 2>&1 &
first=$!
await 60 eval 'tail -n 1 $log | grep "left: stream 2 starts"'
judge bus.second_camera_gets_enospc eval 'v4l2-ctl -d "$(node right)" --stream-mmap --stream-count=1 2>&1 |
    grep "STREAMON returned -1 (No space left on device)"'
kill $first
wait $first
finish
start ,fps=5,alternates=192/1024 --bus-bytes 2048
both_small() {
    take left YUYV 640x480 5 2 &
    other=$!
    take right YUYV 640x480 5 2 && wait $other && all_equal left 640x480 yuyv 2 && all_equal right 640x480 yuyv 2
}
judge bus.small_settings_fit both_small
finish
start ,alternates=192
take right MJPG 640x480 5 2
judge iso.smallest_setting all_equal right 640x480 jpg 2
finish
