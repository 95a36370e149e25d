#!/bin/sh
# The driver over libusb against virtual cameras, in the virtual machine.
#
#   sh tests/vm/uvc.sh [FOLDER]      FOLDER: for the image and what the machine hands out; .build/vm-uvc
set -eu
cd "$(dirname "$0")/../.."
work=${1:-.build/vm-uvc}
mkdir -p "$work"

sh toolchain/cross/sysroot.sh arm64 >/dev/null
quietly() {
    "$@" >"$work/build.log" 2>&1 || { tail -n 30 "$work/build.log" >&2; echo "uvc.sh: this failed: $*" >&2; exit 70; }
}
quietly cmake --preset release
quietly cmake --build --preset release --target make_frames
quietly cmake --preset arm64
quietly cmake --build --preset arm64 --target usbip_camera uvc_capture
tree=$(sh tests/vm/kernel.sh)

rm -rf "$work/frames"
mkdir -p "$work/frames/left" "$work/frames/right"
make_frames=.build/release/tests/support/usbip_camera/make_frames
for size in 640x480 1280x720; do
    $make_frames algo/cloud/aloe.png "$work/frames/left" $size 3 0
    $make_frames algo/cloud/aloe.png "$work/frames/right" $size 3 500
done
rm "$work/frames"/right/1280x720*

# v4l2-ctl is not used; uvcvideo is there to be detached, and to come back.
sh tests/vm/image.sh -o "$work/uvc.cpio" --module vhci-hcd --module uvcvideo \
    --program .build/arm64/tests/vm/guest/usbip_camera/usbip_camera --program .build/arm64/tests/vm/guest/drivers/uvc_capture \
    --file "$work/frames=/frames" --file tests/vm/guest/cameras.sh=/vm/cameras.sh tests/vm/guest/uvc.sh
[ -d "$tree" ]
exec sh tests/vm/run.sh "$work/uvc.cpio" --timeout 280 --out "$work/out"
