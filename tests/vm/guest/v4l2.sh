# Cameras through dicot's V4L2 driver: runs in the virtual machine, before the kernel's own uvcvideo and vivid.
#expect list iso.yuyv iso.mjpeg iso.large bulk.yuyv bulk.mjpeg buffers.all_lent buffers.outlive_the_stream
#expect fault.short fault.drop fault.bad_header fault.err fault.wrong_fid fault.truncate.yuyv fault.truncate.mjpeg
#expect fault.zero_frame fault.no_eof fault.overlong fault.silent fault.late fault.refuse_interface fault.kept_to_itself
#expect fault.product fault.bulk.halt bus.full probe.plans_the_rig probe.json
#expect control.set_and_read control.held_by_automatism control.stall control.mute control.unknown
#expect shake.restart shake.reopen shake.port shake.port_cures shake.gone shake.comes_back
#expect vivid.whole vivid.streamon vivid.qbuf vivid.reqbufs vivid.dropped vivid.error_flag vivid.cycles cycles
. /vm/cameras.sh

# Until its own part: the other tests count nodes.
rmmod vivid

# Damaged frames are handed over with their flag; the driver's default is to keep them to itself.
nodrop=/sys/module/uvcvideo/parameters/nodrop
echo 1 >$nodrop

# Runs the program, shows what it printed, and wants each line (a basic regular expression) to be there.
wants() { # words of v4l2_capture in one, lines
    rm -rf taken
    mkdir taken
    # shellcheck disable=SC2086 # the words
    timeout 240 v4l2_capture $1 >capture.log 2>&1
    code=$?
    tee -a /out/capture.log <capture.log
    [ $code -le 1 ] || return
    shift
    for line; do
        case $line in
            no*) ! grep -q "${line#no }" capture.log || { echo "is there: ${line#no }"; return 1; } ;;
            *) grep -q "$line" capture.log || { echo "is not there: $line"; return 1; } ;;
        esac
    done
}

# Every frame that was taken is byte for byte the file that its number names, and none is missing.
all_equal() { # frames of each camera, format, size, ending
    for camera in 0 1; do
        [ $camera = 0 ] && frames=/frames/left || frames=/frames/right
        files=$(ls "$frames/$3"_*."$4" | wc -l)
        [ "$(grep -c "^frame $camera .* whole" capture.log)" = "$1" ] || { echo "camera $camera: not $1 frames"; return 1; }
        grep "^frame $camera .* whole" capture.log | while read -r _ _ k _ _ _ sequence _; do
            cmp "taken/$camera-$k.$2" "$frames/$3_$((sequence % files)).$4" || exit 1
        done || return
    done
}

both() { # format, size, ending, frames
    wants "1-1,1-2 start $1 $2 5 take $4 ./taken stop" "stopped 1-2" "no failed" && all_equal "$4" "$1" "$2" "$3"
}

# A stream whose frame 2 goes wrong, and the lines that it is to leave.
spoiled() { # fault, format, lines
    format=$2
    say "left next 2 $1" || return
    shift 2
    wants "1-1 start $format 640x480 15 take 5" "$@"
}
yuyv=614400

start ,fps=30/15/5
judge list wants "list" "port 1-1 id 1209:0001 serial 'L1' name 'dicot virtual camera' bus 1 speed 1 descriptors [1-9]" \
    "port 1-2 .* serial 'R1'" "cameras 2 left_out 0 denied 0"
judge iso.yuyv both YUYV 640x480 yuyv 5
judge iso.mjpeg both MJPEG 640x480 jpg 5
large() {
    wants "1-1 start YUYV 1280x720 5 take 2 ./taken" "no failed" && cmp taken/0-0.YUYV /frames/left/1280x720_0.yuyv
}
judge iso.large large
# What the command says, and what of it a program reads.
judge probe.plans_the_rig eval 'timeout 60 dicot probe >said.log 2>&1; cat said.log; grep "left 1-1, right 1-2" said.log'
json() {
    timeout 60 dicot probe --json >/out/probe.json 2>said.log || { cat said.log /out/probe.json; return 1; }
    [ "$(grep -c '^      "port": "1-[12]",$' /out/probe.json)" = 4 ] &&
        [ "$(sed -n '/^  "rig": {$/,$s/^      "port": "\(.*\)",$/\1/p' /out/probe.json | tr '\n' ' ')" = "1-1 1-2 " ]
}
judge probe.json json
judge buffers.all_lent wants "1-1 start YUYV 640x480 30 hold 5 release take 2" "failed 75 .* all its 4 buffers are lent" \
    "released 4 unchanged 4" "frame 0 1 whole"
judge buffers.outlive_the_stream wants \
    "1-1 start YUYV 640x480 30 hold 3 stop start MJPEG 640x480 30 take 5 tries 5 shake reopen take 2 release stop" \
    "held 3" "frame 0 4 whole" "shaken reopen" "released 3 unchanged 3" "no failed"

judge fault.short spoiled "short packet=3 bytes=100" YUYV "frame 0 2 torn $((yuyv - 100)) .* flaw 'error flag, $((yuyv - 100)) bytes'" \
    "frame 0 3 whole"
judge fault.drop spoiled "drop packet=3" YUYV "frame 0 2 torn $((yuyv - 1588))" "frame 0 3 whole"
judge fault.bad_header spoiled "bad_header packet=3 length=0" YUYV "frame 0 2 torn" "frame 0 3 whole"
judge fault.err spoiled "err packet=3" YUYV "frame 0 2 torn $yuyv .* flaw 'error flag" "frame 0 3 whole"
judge fault.wrong_fid spoiled "wrong_fid packet=3" YUYV "frame 0 2 torn" "frame 0 4"
judge fault.truncate.yuyv spoiled "truncate byte=5000" YUYV "frame 0 2 torn 5000" "frame 0 3 whole"
# The driver finds nothing wrong with half a JPEG.
judge fault.truncate.mjpeg spoiled "truncate byte=5000" MJPEG "frame 0 2 torn 5000 .* flaw 'no end marker after 5000 bytes'" \
    "frame 0 3 whole"
judge fault.zero_frame spoiled zero_frame YUYV "frame 0 2 whole" "frame 0 3 whole .* sequence 4 lost 1"
judge fault.no_eof spoiled no_eof YUYV "frame 0 3 whole .* sequence 4 lost 1"
judge fault.overlong spoiled overlong YUYV "frame 0 2 torn" "frame 0 3 whole"
silent() {
    say "left next 2 silent" || return
    wants "1-1 start YUYV 640x480 15 take 2 wait 800 take 1 wait 10000 shake restart take 4" \
        "failed 75 camera 1-1: no frame came in time" "shaken restart 1-1" "frame 0 3 whole .* sequence 3 "
}
judge fault.silent silent
late() {
    say "left next 2 late ms=3000" || return
    wants "1-1 start YUYV 640x480 15 take 2 wait 500 take 1 wait 20000 take 1" \
        "failed 75 camera 1-1: no frame came in time" "frame 0 0 whole .* sequence 2 lost 0 "
}
judge fault.late late
refused() {
    say "left control refuse_interface errno=32" || return
    wants "1-1 start YUYV 640x480 15 start YUYV 640x480 15 take 1" "failed 69 .*starting to stream failed" "frame 0 0 whole"
}
judge fault.refuse_interface refused

judge control.set_and_read wants "1-1 set brightness -7 get brightness" "set 1-1 brightness -7" "get 1-1 brightness -7"
judge control.held_by_automatism wants \
    "1-1 set exposure_auto 8 set exposure_time 100 set exposure_auto 1 set exposure_time 100 controls set exposure_auto 8" \
    "failed 69 .*'exposure_time' cannot be set now; switch its automatic off first" "set 1-1 exposure_auto 1" \
    "set 1-1 exposure_time 100" "control 1-1 exposure_time .* is 100"
stall() {
    say "left control stall unit=2 selector=2 request=set_cur" || return
    wants "1-1 set brightness 4 set brightness 5" "failed 69 camera 1-1" "set 1-1 brightness 5"
}
judge control.stall stall
mute() {
    say "left control mute unit=2 selector=2 request=set_cur" || return
    began=$(cut -d. -f1 /proc/uptime)
    wants "1-1 set brightness 6 set brightness 7" "failed 69 camera 1-1" "set 1-1 brightness 7" &&
        [ $(($(cut -d. -f1 /proc/uptime) - began)) -lt 25 ]
}
judge control.mute mute
judge control.unknown wants "1-1 get sharpness set contrast 100000" "no get 1-1" "failed 69"

judge shake.restart wants "1-1 start YUYV 640x480 30 take 2 shake restart take 3" "shaken restart" \
    "frame 0 2 whole .* sequence 2 " "no failed"
judge shake.reopen wants "1-1 start MJPEG 640x480 30 take 2 tries 5 shake reopen take 3" "shaken reopen" \
    "frame 0 2 whole" "no failed"
judge shake.port wants "1-1 start YUYV 640x480 30 take 2 tries 5 shake port take 3 controls" "shaken port" \
    "frame 0 2 whole" "no failed"
hang() {
    say "left next 2 hang" || return
    wants "1-1 start YUYV 640x480 15 take 2 wait 700 take 1 shake restart take 1 wait 10000 tries 5 shake port take 3" \
        "failed 75 camera 1-1: no frame came in time" "shaken port" "frame 0 2 whole"
    [ "$(grep -c "^failed 75" capture.log)" = 2 ]
}
judge shake.port_cures hang
gone() {
    say "left next 2 unplug byte=5000 back_ms=60000" || return
    wants "1-1 start YUYV 640x480 15 take 3 stop shake reopen get brightness" "frame 0 1 whole" "failed 69 camera 1-1:" \
        "failed 69 there is no camera at '1-1'" "no frame 0 2 whole"
}
judge shake.gone gone
say "left now plug"
await 60 both_there
back() {
    say "left next 2 unplug byte=5000 back_ms=700" || return
    wants "1-1,1-2 start YUYV 640x480 5 take 3 tries 10 shake reopen take 4" "failed 69 camera 1-1:" "shaken reopen 1-1" \
        "shaken reopen 1-2" "frame 0 3 whole" "frame 1 3 whole"
}
judge shake.comes_back back
judge cycles wants "1-1,1-2 start MJPEG 640x480 30 cycles 150" \
    "cycles 150 whole 300 descriptors \([0-9]*\) \1 maps \([0-9]*\) \2 .* grown no allocated 0 "
finish

echo 0 >$nodrop # the driver asks when a camera is plugged in
start ,fps=15
judge fault.kept_to_itself spoiled "err packet=3" YUYV "frame 0 2 whole .* sequence 3 lost 1" "no torn"
echo 1 >$nodrop
renamed() {
    say "left now unplug" && await 60 test ! -e /sys/bus/usb/devices/1-1 && say 'left plug product text=two\x1b[31mred\xff' \
        "left now plug" && await 60 both_there && wants "list" "name 'two?\[31mred"
}
judge fault.product renamed
finish

start ,fps=30/15/5,transfer=bulk
judge bulk.yuyv both YUYV 640x480 yuyv 3
judge bulk.mjpeg both MJPEG 640x480 jpg 3
# The driver gives back what is queued, without a picture, and stops without a word.
halted() {
    say "left next 2 halt packet=3" || return
    wants "1-1 start YUYV 640x480 15 take 2 wait 1500 drain shake restart wait 10000 take 3" "frame 0 1 whole .* sequence 1 " \
        "frame 0 0 torn 0 " "failed 75 camera 1-1: no frame came in time" "shaken restart" \
        "frame 0 2 whole .* sequence 2 "
}
judge fault.bulk.halt halted
finish

start ,payload=most --bus-bytes 6000
judge bus.full wants "1-1,1-2 start YUYV 640x480 5 stop" "started 1-1" "failed 75 camera 1-2: its USB bus has no bandwidth left"
finish

# --- vivid: the kernel's own test camera, which fails on demand

insmod /vm/modules/vivid.ko n_devs=1 node_types=0x1 input_types=0x0
await 60 test -c /dev/video0
vivid=platform:vivid-000
await 60 v4l2-ctl -d /dev/video0 --list-ctrls
inject() { v4l2-ctl -d /dev/video0 --set-ctrl "$1"; }
judge vivid.whole wants "$vivid start YUYV 640x480 25 take 5 stop start GREY 640x360 25 take 1 start NV12 640x360 25 take 1" \
    "frame 0 4 whole $yuyv" "frame 0 0 whole 230400" "frame 0 0 whole 345600" "no failed"
vivid_refuses() { # control, what the driver says
    inject "$1=1" || return
    wants "$vivid start YUYV 640x480 25 start YUYV 640x480 25 take 2" "failed 69 .*$2" "frame 0 1 whole"
}
judge vivid.streamon vivid_refuses inject_vidioc_streamon_error "starting to stream failed"
judge vivid.qbuf vivid_refuses inject_vidioc_qbuf_error "queueing a buffer failed"
judge vivid.reqbufs vivid_refuses inject_vidioc_reqbufs_error "asking for buffers failed"
dropped() {
    inject percentage_of_dropped_buffers=50 || return
    wants "$vivid start YUYV 640x480 25 take 12" "lost [1-9]" "frame 0 11 whole" "no failed"
    result=$?
    inject percentage_of_dropped_buffers=0 && return $result
}
judge vivid.dropped dropped
flagged() {
    inject inject_v4l2_buf_flag_error=1 || return
    wants "$vivid start YUYV 640x480 25 take 5" "torn .* flaw 'error flag" "frame 0 4 whole" "no failed"
}
judge vivid.error_flag flagged
judge vivid.cycles wants "$vivid start YUYV 640x360 50 cycles 700" \
    "cycles 700 whole 700 descriptors \([0-9]*\) \1 maps \([0-9]*\) \2 .* grown no allocated 0 "
