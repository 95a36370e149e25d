#!/bin/sh
# Proves the virtual machine and the virtual cameras, without any driver of dicot: the kernel's own driver and v4l2-ctl see
# every frame byte for byte, and every fault as what it is meant to be.
#
#   sh tests/vm/selfcheck.sh [FOLDER]      FOLDER: for the image and what the machine hands out; .build/vm
set -eu
cd "$(dirname "$0")/../.."
work=${1:-.build/vm}
mkdir -p "$work"

sh toolchain/cross/sysroot.sh arm64 >/dev/null
quietly() {
    "$@" >"$work/build.log" 2>&1 || { tail -n 30 "$work/build.log" >&2; echo "selfcheck.sh: this failed: $*" >&2; exit 70; }
}
quietly cmake --preset release
quietly cmake --build --preset release --target make_frames
quietly cmake --preset arm64
quietly cmake --build --preset arm64 --target usbip_camera
tree=$(sh tests/vm/kernel.sh)

# Two views of one picture, three frames of each, two sizes.
rm -rf "$work/frames"
mkdir -p "$work/frames/left" "$work/frames/right"
for size in 640x480 1280x720; do
    .build/release/tests/support/usbip_camera/make_frames algo/cloud/aloe.png "$work/frames/left" $size 3 0
    .build/release/tests/support/usbip_camera/make_frames algo/cloud/aloe.png "$work/frames/right" $size 3 500
done
rm "$work/frames"/right/1280x720*

sh tests/vm/image.sh -o "$work/selfcheck.cpio" --module vhci-hcd --module uvcvideo \
    --program "$tree/usr/bin/v4l2-ctl" --program .build/arm64/tests/vm/guest/usbip_camera/usbip_camera \
    --file "$work/frames=/frames" --file tests/vm/guest/cameras.sh=/vm/cameras.sh tests/vm/guest/selfcheck.sh
exec sh tests/vm/run.sh "$work/selfcheck.cpio" --timeout 240 --out "$work/out"
