# The driver over libusb before virtual cameras: runs in the virtual machine. Frames are compared with the files that the
# cameras serve.
#expect uvc.list uvc.iso.yuyv uvc.iso.mjpeg uvc.iso.large uvc.driver_given_back uvc.by_serial uvc.no_such_camera
#expect uvc.controls uvc.bulk.yuyv uvc.bulk.mjpeg uvc.bulk.payload_of_several_transfers uvc.iso.smallest_setting
#expect uvc.fault.short uvc.fault.drop uvc.fault.bad_header uvc.fault.err uvc.fault.wrong_fid uvc.fault.truncate.yuyv
#expect uvc.fault.truncate.mjpeg uvc.fault.zero_frame uvc.fault.no_eof uvc.fault.overlong uvc.fault.silent
#expect uvc.fault.late uvc.fault.bulk.short uvc.fault.bulk.drop uvc.fault.bulk.halt uvc.fault.cut_anywhere uvc.fault.refuse_interface uvc.fault.unplug uvc.fault.cut_descriptors
#expect uvc.leases_outlive_their_stream uvc.fault.probe_stalls uvc.fault.probe_is_mute uvc.fault.probe_is_short
#expect uvc.fault.control_stalls uvc.ladder.restart uvc.ladder.reopen uvc.ladder.gone
#expect uvc.bus.planned_settings_are_tried uvc.fault.product uvc.bus.second_camera_gets_enospc uvc.bus.small_settings_fit uvc.cycles
# shellcheck source=tests/vm/guest/cameras.sh
. /vm/cameras.sh

yuyv=614400

# Every frame of the log is whole and is byte for byte the file that its number names.
all_equal() { # port, camera, size, format, ending, frames
    files=$(ls "/frames/$2/$3"_*."$5" | wc -l)
    seen=0
    while read -r port number verdict _ _ _ sequence _; do
        [ "$port" = "$1" ] && [ "$number" != streams ] || continue
        [ "$verdict" = whole ] || return 1
        cmp "shots/$1-$number.$4" "/frames/$2/$3_$((${sequence%,} % files)).$5" || return
        seen=$((seen + 1))
    done <shots.log
    [ $seen = "$6" ]
}
shoot() { # format, width, height, fps, frames, cameras ...
    rm -rf shots
    timeout 120 uvc_capture capture shots "$@" >shots.log 2>&1
    code=$?
    cat shots.log
    return $code
}
both() { # format, ending
    shoot "$1" 640 480 5 5 1-1 1-2 && all_equal 1-1 left 640x480 "$1" "$2" 5 && all_equal 1-2 right 640x480 "$1" "$2" 5
}
# A stream whose frame 2 goes wrong, and words that its lines are to begin with behind the port.
spoiled() { # fault, format, lines
    say "left next 2 $1" || return
    shoot "$2" 640 480 15 5 1-1
    shift 2
    for line; do
        grep -q "^1-1 $line" shots.log || { echo "is not there: $line"; return 1; }
    done
}
says() { # sentence, command ...
    sentence=$1
    shift
    "$@" >said.log 2>&1
    cat said.log
    grep -q "$sentence" said.log
}

# --- isochronous

start ,fps=30/15/5
judge uvc.list eval 'uvc_capture list >said.log && cat said.log && grep "^1-1 .*L1" said.log &&
    grep "^1-2 .*R1" said.log'
judge uvc.iso.yuyv both YUYV yuyv
grep '^cpu' shots.log # for the record
judge uvc.iso.mjpeg both MJPEG jpg
large() { shoot YUYV 1280 720 5 3 1-1 && all_equal 1-1 left 1280x720 YUYV yuyv 3; }
judge uvc.iso.large large
judge uvc.driver_given_back await 60 both_there
serial() { shoot YUYV 640 480 5 1 R1 && cmp shots/R1-0.YUYV /frames/right/640x480_0.yuyv; }
judge uvc.by_serial serial
judge uvc.no_such_camera says "no camera at USB port or with serial number '9-9'" uvc_capture controls 9-9
controls() {
    uvc_capture controls 1-1 >said.log 2>&1
    cat said.log
    grep -q '^brightness -64..64 step 1 usual 0 now 0 set 0 $' said.log &&
        grep -q '^exposure_auto .* usual 8 now 8 set 8 $' said.log && grep -q '^exposure_time .*wrong state' said.log
}
judge uvc.controls controls

judge uvc.fault.short spoiled "short packet=3 bytes=100" YUYV "1 whole" "2 torn .* 614300 of $yuyv bytes" "3 whole"
judge uvc.fault.drop spoiled "drop packet=3" YUYV "1 whole" "2 torn $((yuyv - 1588)) bytes.*lost packet" "3 whole"
judge uvc.fault.bad_header spoiled "bad_header packet=3 length=0" YUYV "2 torn .*bad payload header" "3 whole"
judge uvc.fault.err spoiled "err packet=3" YUYV "1 whole" "2 torn .*error bit" "3 whole"
judge uvc.fault.wrong_fid spoiled "wrong_fid packet=3" YUYV "1 whole" "2 torn .* $((3 * 1588)) of $yuyv bytes" "4 torn"
judge uvc.fault.truncate.yuyv spoiled "truncate byte=5000" YUYV "1 whole" "2 torn .* 5000 of $yuyv bytes" "3 whole"
judge uvc.fault.truncate.mjpeg spoiled "truncate byte=5000" MJPEG "1 whole" "2 torn .*no JPEG end marker" "3 whole"
judge uvc.fault.zero_frame spoiled zero_frame YUYV "1 whole" "2 torn .*no bytes" "3 whole"
judge uvc.fault.no_eof spoiled no_eof YUYV "2 whole" "3 whole" "4 whole"
judge uvc.fault.overlong spoiled overlong YUYV "1 whole" "2 torn .* of $yuyv bytes" "3 whole"
silent() {
    say "left next 2 silent" && shoot YUYV 640 480 15 3 1-1
    grep 'delivered no frame in time' shots.log
}
judge uvc.fault.silent silent
# Starts of frames 1 and 2, a second and a half apart or more.
late() {
    spoiled "late ms=3000" YUYV "1 whole" "2 whole" "4 whole" || return
    sed -n 's/^1-1 \([12]\) whole.* start \([0-9]*\).*/\2/p' shots.log | { read -r one && read -r two &&
        [ $((two - one)) -gt 1500000 ]; }
}
judge uvc.fault.late late
refused() {
    say "left control refuse_interface errno=32" && ! shoot YUYV 640 480 15 1 1-1 && shoot YUYV 640 480 15 1 1-1
}
judge uvc.fault.refuse_interface refused
unplugged() {
    say "left next 2 unplug byte=5000 back_ms=700" || return
    ! shoot YUYV 640 480 15 5 1-1 && grep '^1-1 2 cancelled .*the camera went away' shots.log &&
        grep 'is gone' shots.log && await 60 node left && shoot YUYV 640 480 15 1 1-1
}
judge uvc.fault.unplug unplugged
gone() { [ ! -e /sys/bus/usb/devices/1-1 ]; }
cut_short() {
    say "left now unplug" && await 60 gone && say "left plug cut_descriptors byte=100" "left now plug" &&
        await 60 test -f /sys/bus/usb/devices/1-1/product
    says 'USB port 1-1 cannot be used' uvc_capture controls 1-1
}

hold() {
    rm -rf shots
    timeout 120 uvc_capture hold shots YUYV 640 480 15 4 1-1 >shots.log 2>&1 && all_equal 1-1 left 640x480 YUYV yuyv 4
}
judge uvc.leases_outlive_their_stream hold

# Unit 0 is the streaming interface, selector 1 its probe control.
probe() { # fault, sentence
    say "left control $1" || return
    ! shoot YUYV 640 480 15 1 1-1 && grep "$2" shots.log && shoot YUYV 640 480 15 1 1-1
}
judge uvc.fault.probe_stalls probe "stall unit=0 selector=1 request=set_cur" 'refuses: offer a mode'
judge uvc.fault.probe_is_mute probe "mute unit=0 selector=1 request=get_cur" 'does not answer: hear its answer'
judge uvc.fault.probe_is_short probe "short_reply unit=0 selector=1 request=get_cur bytes=10" '10 of 26 bytes'
control_stalls() {
    say "left control stall unit=2 selector=2 request=set_cur" &&
        says '^brightness .* set -1 .*refuses: set brightness, ' uvc_capture controls 1-1 &&
        says '^brightness .* set 0 $' uvc_capture controls 1-1
}
judge uvc.fault.control_stalls control_stalls
climbs() { # lines that come one after the other
    timeout 240 uvc_capture ladder YUYV 640 480 15 6 1-1 >climb.log 2>&1
    code=$?
    cat climb.log
    for line; do
        grep -q "$line" climb.log || return
    done
    [ $code = 0 ]
}
judge uvc.ladder.restart eval 'say "left next 2 silent" && climbs "no frame in time" "shake restart: ok" "^1-1 5 whole"'
judge uvc.ladder.reopen eval 'say "left next 2 unplug byte=5000 back_ms=700" &&
    climbs "^1-1 2 cancelled" "is gone" "^1-1 5 whole"'
grep shake climb.log
lost() {
    say "left next 2 unplug byte=5000" || return
    ! climbs "^1-1 2 cancelled" "shake port: there is no camera" && await 60 gone && say "left now plug" && await 60 both_there
}
judge uvc.ladder.gone lost
judge uvc.fault.cut_descriptors cut_short
# The configuration ends at every 25th byte, in the middle of descriptors and between them; the unit tests have every byte.
# The kernel reads it and uvcvideo takes what it can; then it is our turn: a refusal, within a bound.
number_of_device() { cat /sys/bus/usb/devices/1-1/devnum 2>/dev/null; }
another_device() {
    number=$(number_of_device)
    [ -n "$number" ] && [ "$number" != "$before" ] && [ -f /sys/bus/usb/devices/1-1/product ]
}
cut_anywhere() {
    for cut in 9 25 50 75 100 125 150 175 200 225 250 275 300 325 350 375 400 411; do
        before=$(number_of_device)
        printf 'left now unplug\nleft now forget\nleft plug cut_descriptors byte=%d\nleft now plug\n' $cut >$commands
        await 60 another_device || { echo "cut at $cut: the kernel shows no device"; return 1; }
        cat /sys/bus/usb/devices/1-1/bConfigurationValue # waits until uvcvideo has seen to it
        timeout 60 uvc_capture list >said.log 2>&1 || { echo "cut at $cut: no list: $?"; cat said.log; return 1; }
        timeout 60 uvc_capture controls 1-1 >said.log 2>&1
        code=$?
        echo "cut at $cut: $(tail -n 1 said.log)" >>/out/cuts.log
        # The kernel leaves the camera's interface away, or shows it and less than it was told of.
        case $(cat said.log) in
            *"USB port 1-1 cannot be used: its configuration is cut short"*) [ $code = 65 ] ;;
            *"there is no camera at USB port"*"'1-1'"*) [ $code = 69 ] ;;
            *) false ;;
        esac || { echo "cut at $cut: $code"; cat said.log; return 1; }
    done
    say "left now unplug" && await 60 gone && say "left now forget" "left now plug" && await 60 both_there &&
        shoot YUYV 640 480 15 1 1-1
}
judge uvc.fault.cut_anywhere cut_anywhere
product() {
    say "left now unplug" && await 60 gone && say "left now forget" 'left plug product text=\x1b[31mred' "left now plug" &&
        await 60 both_there && says "'?.31mred'" uvc_capture list
}
judge uvc.fault.product product
say "left now forget"
cycles() {
    uvc_capture cycles YUYV 640 480 15 1001 1-2 >said.log 2>&1
    code=$?
    cat said.log
    [ $code = 0 ] || return
    [ "$(sed -n 's/.*, \(resident.*\)/\1/p; s/^after.*: \(resident.*\)/\1/p' said.log | tail -n 3 | sort -u | wc -l)" = 1 ]
}
judge uvc.cycles cycles
cat said.log
finish

# --- bulk

start ,fps=30/15/5,transfer=bulk
judge uvc.bulk.yuyv both YUYV yuyv
judge uvc.bulk.mjpeg both MJPEG jpg
judge uvc.fault.bulk.short spoiled "short packet=3 bytes=100" YUYV "2 torn .* 614300 of $yuyv bytes" "3 whole"
judge uvc.fault.bulk.halt eval 'say "left next 2 halt packet=3" &&
    climbs "^1-1 1 whole" "halted its endpoint" "shake restart: ok" "^1-1 5 whole"'
judge uvc.fault.bulk.drop spoiled "drop packet=3" YUYV "2 torn .* $((yuyv - 16372)) of $yuyv bytes" "3 whole"
finish
start ,transfer=bulk,payload=40000
several() { shoot YUYV 640 480 5 2 1-1 && all_equal 1-1 left 640x480 YUYV yuyv 2; }
judge uvc.bulk.payload_of_several_transfers several
finish

# --- two cameras on one bus

start ,payload=most --bus-bytes 6000
judge uvc.bus.second_camera_gets_enospc says 'the bus of USB port 1-2 has no bandwidth left' \
    uvc_capture capture shots YUYV 640 480 5 1 1-1 1-2
# The plan's smaller setting, although the camera asks for its largest.
planned() {
    shoot YUYV 640 480 5 2 1-1@2 1-2@2
    grep '^1-1 streams .* alternate 2$' shots.log && grep '^1-2 streams .* alternate 2$' shots.log &&
        all_equal 1-1 left 640x480 YUYV yuyv 2 && all_equal 1-2 right 640x480 YUYV yuyv 2
}
judge uvc.bus.planned_settings_are_tried planned
finish
start ,fps=5,alternates=192/1024 --bus-bytes 2048
small() {
    shoot YUYV 640 480 5 2 1-1 1-2 && all_equal 1-1 left 640x480 YUYV yuyv 2 && all_equal 1-2 right 640x480 YUYV yuyv 2
}
judge uvc.bus.small_settings_fit small
finish
start ,alternates=192
smallest() { shoot MJPEG 640 480 5 2 1-2 && all_equal 1-2 right 640x480 MJPEG jpg 2; }
judge uvc.iso.smallest_setting smallest
finish
