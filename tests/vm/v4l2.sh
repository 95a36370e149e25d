#!/bin/sh
# Proves dicot's V4L2 driver in the virtual machine: virtual webcams behind uvcvideo, and vivid.
#
#   sh tests/vm/v4l2.sh [FOLDER]      FOLDER: for the image and what the machine hands out; .build/vm-v4l2
set -eu
cd "$(dirname "$0")/../.."
work=${1:-.build/vm-v4l2}
mkdir -p "$work"

sh toolchain/cross/sysroot.sh arm64 >/dev/null
quietly() {
    "$@" >"$work/build.log" 2>&1 || { tail -n 30 "$work/build.log" >&2; echo "v4l2.sh: this failed: $*" >&2; exit 70; }
}
quietly cmake --preset release
quietly cmake --build --preset release --target make_frames
quietly cmake --preset arm64
quietly cmake --build --preset arm64 --target usbip_camera v4l2_capture
tree=$(sh tests/vm/kernel.sh)

rm -rf "$work/frames"
mkdir -p "$work/frames/left" "$work/frames/right"
for size in 640x480 1280x720; do
    .build/release/tests/support/usbip_camera/make_frames algo/cloud/aloe.png "$work/frames/left" $size 3 0
    .build/release/tests/support/usbip_camera/make_frames algo/cloud/aloe.png "$work/frames/right" $size 3 500
done
rm "$work/frames"/right/1280x720*

sh tests/vm/image.sh -o "$work/v4l2.cpio" --module vhci-hcd --module uvcvideo --module vivid \
    --program "$tree/usr/bin/v4l2-ctl" --program .build/arm64/tests/vm/guest/usbip_camera/usbip_camera \
    --program .build/arm64/tests/vm/guest/drivers/v4l2_capture \
    --file "$work/frames=/frames" --file tests/vm/guest/cameras.sh=/vm/cameras.sh tests/vm/guest/v4l2.sh
exec sh tests/vm/run.sh "$work/v4l2.cpio" --timeout 300 --out "$work/out"
