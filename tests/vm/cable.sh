#!/bin/sh
# What happens to the cable between board and computer while `dicot pull` reads: it is pulled, the computer resets its port, sleeps, fills its
# disk or dies, the board takes new snapshots, prunes or dies, and a computer that means harm says what it likes.
#
#   sh tests/vm/cable.sh [FOLDER]      FOLDER: for all that it makes; .build/vm-cable
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
