#!/bin/sh
# Proves the virtual machine and the virtual cameras, without any driver of dicot: the kernel's own driver and v4l2-ctl see
# every frame byte for byte, and every fault as what it is meant to be.
#
#   sh tests/vm/selfcheck.sh [FOLDER]      FOLDER: for the image and what the machine hands out; .build/vm-selfcheck
cd "$(dirname "$0")/../.." || exit 70
name=selfcheck
. tests/vm/machine.sh

build_all
make_frames
run_machine 480 --program "$tree/usr/bin/v4l2-ctl"
