#!/bin/sh
# From two cameras to one cloud: `dicot snap` in the virtual machine, through the kernel's driver and through libusb, stores point
# for point the cloud that `dicot process` makes here of the same pictures as PNG files. YUYV carries them without loss: the files
# are what the frames decode to. What the cloud says about itself differs: a snapshot has a number, a time and a board.
#
#   sh tests/vm/snap.sh [FOLDER]      FOLDER: for the image and what the machine hands out; .build/vm-snap
#
# The pair is the Aloe of Middlebury 2006, a column narrower (a YUYV frame has an even width), where its data lies beside the
# checkout; elsewhere the pair that dicot draws by itself where there is no camera.
cd "$(dirname "$0")/../.." || exit 70
name=snap
. tests/vm/machine.sh

build_all dicot
dicot=.build/release/platform/app/dicot
tools=.build/release/tests/support/usbip_camera
rm -rf "$work/frames" "$work/files"
mkdir -p "$work/frames/left" "$work/frames/right" "$work/files"
pair=${DICOT_DATA_DIR:-../shared/data}/plants/aloe-third
if [ -f "$pair/left.png" ]; then
    size=426x370
    sed 's/^image_width: 427$/image_width: 426/' tests/support/data/aloe-third.yaml >"$work/files/rig.yaml"
else
    echo "NOT RUN: the Aloe pair: $pair is not there; a drawn pair is used"
    size=320x240
    cp tests/support/data/drawn-pair.yaml "$work/files/rig.yaml"
    rm -rf "$work/drawn"
    quietly "$dicot" snap --raw -o "$work/drawn"
    pair=$(echo "$work"/drawn/*/*/0*)
    mv "$pair/raw_left.png" "$pair/left.png"
    mv "$pair/raw_right.png" "$pair/right.png"
fi
for side in left right; do
    quietly "$tools/make_frames" "$pair/$side.png" "$work/frames/$side" $size 1
    quietly "$tools/frame_to_png" "$work/frames/$side/${size}_0.yuyv" $size "$work/files/$side.png"
    rm "$work/frames/$side/${size}_0.jpg"
done
# A large window takes more than a minute under emulation: one driver has the usual one, the other a small one.
process() { # driver, window
    quietly "$dicot" process "$work/files/left.png" "$work/files/right.png" --rig "$work/files/rig.yaml" --window "$2" \
        -o "$work/$1.drc"
    quietly "$dicot" export "$work/$1.drc" -o "$work/$1.ply"
    sh tests/vm/guest/points.sh "$work/$1.ply" >"$work/files/$1.points"
}
process v4l2 35
process uvc 11
cat >"$work/files/dicot.toml" <<END
[cameras]
left = "port:1-1"
right = "port:1-2"
driver = "DRIVER"
formats = ["YUYV"]
width = ${size%x*}
height = ${size#*x}
fps = 15
[burst]
most_skew_ms = 1000.0
[matching]
window = WINDOW
[output]
device = "board"
reserve_mib = 16
[rig]
file = "/files/rig.yaml"
END
run_machine 480 --program .build/arm64/platform/app/dicot --file "$work/files=/files" --file tests/vm/guest/points.sh=/vm/points.sh
