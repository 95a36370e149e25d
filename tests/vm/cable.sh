#!/bin/sh
# The board on a computer's cable: a kernel's gadget and a kernel's host in one machine (dummy_hcd). Real clients that nobody here
# wrote, and `dicot pull`, read `dicot gadget up`; `dicot pull` reads umtp-responder and QEMU's usb-mtp.
#
#   sh tests/vm/mtp.sh [FOLDER]      FOLDER: for all that it makes; .build/vm-mtp
#
# The machine has a clock of its own (run.sh): what is measured in there does not know how busy its host is.
cd "$(dirname "$0")/../.." || exit 70
name=cable
. tests/vm/machine.sh
. tests/vm/board.sh
dicot=.build/release/platform/app/dicot

build_all dicot trial_host cable_counter store_writer
make_store
run_board 400 --module usbmon --file "$built/mtp/cable_counter=/vm/bin/cable_counter" --file "$built/store/store_writer=/vm/bin/store_writer"
