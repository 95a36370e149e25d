#!/bin/sh
# The driver over libusb against virtual cameras, in the virtual machine. uvcvideo is there to be detached, and to come back.
#
#   sh tests/vm/uvc.sh [FOLDER]      FOLDER: for the image and what the machine hands out; .build/vm-uvc
cd "$(dirname "$0")/../.." || exit 70
name=uvc
. tests/vm/machine.sh

build_all uvc_capture
make_frames
run_machine 480 --program "$built/drivers/uvc_capture"
