#!/bin/sh
# Proves dicot's V4L2 driver in the virtual machine: virtual webcams behind uvcvideo, and vivid.
#
#   sh tests/vm/v4l2.sh [FOLDER]      FOLDER: for the image and what the machine hands out; .build/vm-v4l2
cd "$(dirname "$0")/../.." || exit 70
name=v4l2
. tests/vm/machine.sh

build_all v4l2_capture dicot
make_frames
run_machine 480 --module vivid --program "$tree/usr/bin/v4l2-ctl" --program "$built/drivers/v4l2_capture" \
    --program .build/arm64/platform/app/dicot
