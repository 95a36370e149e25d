#!/bin/sh
# The board on a computer's cable: a kernel's gadget and a kernel's host in one machine (dummy_hcd). Real clients that nobody here
# wrote, and `dicot pull`, read `dicot gadget up`; `dicot pull` reads umtp-responder and QEMU's usb-mtp.
#
#   sh tests/vm/mtp.sh [FOLDER]      FOLDER: for all that it makes; .build/vm-mtp
#
# The machine has a clock of its own (run.sh): what is measured in there does not know how busy its host is.
cd "$(dirname "$0")/../.." || exit 70
name=mtp
. tests/vm/machine.sh
. tests/vm/board.sh
dicot=.build/release/platform/app/dicot

build_all dicot trial_host
make_store
rm -rf "$work/elsewhere"
mkdir "$work/elsewhere"
cp -R "$work/store/board" "$work/elsewhere/elsewhere"
run_board 400 --module fuse --module xhci-pci -- --qemu "-device qemu-xhci -device usb-mtp,rootdir=$(realpath "$work")/elsewhere,desc=elsewhere,serial=qemu0"
