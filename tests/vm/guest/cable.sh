# What happens to a cable, and to both who hold it: runs in the virtual machine.
#expect cut.each_64_kib cut.resumes reset.amid stopped.reader sessions.thousand two_clients.in_turn
#expect new.during_a_pull pruned.during_a_pull full.keeps_what_it_has full.goes_on killed.puller killed.server
#expect hostile.comes_back hostile.memory hostile.normal_client
. /vm/board.sh
mount -t debugfs debugfs /sys/kernel/debug 2>/dev/null
store /vm/store
up || failed cable "the gadget does not come up"

# Runs dicot pull and has it stopped, or the cable pulled, once so many bytes came over; $cut: how many they were then, $puller: its
# process. ended() waits for it: $code, and how many bytes $came in all.
amid() { # bytes, stop or unbind, archive
    [ "$2" = stop ] && what=stop || what=unbind=${gadgets:?}/dicot/UDC
    rm -f told
    mkfifo told
    timeout 300 cable_counter --at "$1" "$what" -- dicot pull "$3" --all --json 3>told >pull.json 2>pull.log &
    counter=$!
    exec 3<told
    read -r word cut puller <&3
    [ "$word" = at ] || { echo "the pull ended behind $cut bytes"; came=$cut; }
}
ended() {
    [ "$word" != at ] || read -r _ came <&3
    exec 3<&-
    wait "$counter"
    code=$?
    { echo "--- exit code $code"; cat pull.json pull.log; } >>/out/pull.log
}
go_on() { kill -CONT "$puller"; }
# How much came over in a pull, by the kernel's record of the bus.
counted_pull() { # archive
    timeout 300 cable_counter -- dicot pull "$1" --all --json 3>told.count >pull.json 2>pull.log
    code=$?
    read -r _ came <told.count
    cat pull.json pull.log >>/out/pull.log
    [ $code = 0 ] || cat pull.json pull.log
    return $code
}

# --- the cable is pulled: a board with one snapshot, an archive without any, a cut at each 64 KiB
rm -rf one && mkdir -p one/board
cp -R "$(ls -d /vm/store/board/[12]* | tail -n 1)" one/board/
large=$(du -bs one/board/*/* | cut -f1)
down && store one && up || failed cut "no board with one snapshot"
counted_pull whole && whole=$came
figure "a snapshot of $large bytes: $whole came over"
resumed=''
each_64_kib() {
    at=65536 cuts=0
    while [ $at -lt "$whole" ]; do
        rm -rf cut
        amid $at unbind cut
        ended
        cut=$came
        [ "$code" != 0 ] || [ "$cut" -ge "$large" ] || { echo "cut at $cut: the pull says that it is done"; return 1; }
        nothing_half cut || { echo "cut at $cut: something half in its place"; return 1; }
        kept=$(du -bs cut/board/incoming/* 2>/dev/null | cut -f1)
        plug && counted_pull cut && same cut || { echo "cut at $cut, ${kept:-0} bytes kept"; return 1; }
        resumed="$resumed $cut:${kept:-0}:$came"
        cuts=$((cuts + 1)) at=$((at + 65536))
    done
    figure "the cable was pulled $cuts times, behind$(echo "$resumed" | tr ' ' '\n' | sed -n 's/:.*//p' | tr '\n' ' ' | sed 's/^/ /')bytes"
    [ $cuts -ge 5 ]
}
judge cut.each_64_kib each_64_kib
# What was there is not asked for again: the piece that was under way is, and 64 KiB are for what is said around.
resumes() {
    echo "$resumed" >>/out/resumed
    echo "$resumed" | tr ' ' '\n' | awk -F: -v whole="$whole" 'NF == 3 { n++; if ($2 > 0) kept++; if ($2 + $3 > whole + 2 * 65536) { print; bad = 1 } }
        END { print n, kept; exit bad || !kept }'
}
judge cut.resumes resumes

# --- the computer resets its port
down && store /vm/store && up || failed reset "no board with three snapshots"
reset_amid() {
    rm -rf reset
    amid 800000 stop reset
    trial_host reset
    go_on
    ended
    nothing_half reset || return
    [ $code = 0 ] || pull reset || return
    same reset
}
judge reset.amid reset_amid

# --- the computer sleeps amid a transfer
stopped() {
    rm -rf stopped
    amid 800000 stop stopped
    sleep 60
    go_on
    ended
    nothing_half stopped || return
    [ "$code" = 0 ] || { echo "the pull ended with $code"; cat pull.log; return 1; }
    same stopped
}
judge stopped.reader stopped

judge sessions.thousand eval 'trial_host sessions 1000 && pull thousand && same thousand'
in_turn() {
    for round in 1 2 3; do
        mtp-files >files 2>&1 && [ "$(grep -c '^File ID' files)" = "$(shown clouds | wc -l)" ] || { grep -c '^File ID' files; return 1; }
        pull turn$round && same turn$round || return
    done
}
judge two_clients.in_turn in_turn

# --- the board goes on meanwhile
new_during() {
    rm -rf new
    amid 500000 stop new
    store_writer --seed 5 --first 100 --count 12 --reserve 65536 clouds/board >writer.log 2>&1
    chown -R dicot:dicot clouds
    go_on
    ended
    tail -n 1 writer.log
    [ $code = 0 ] || { cat pull.json pull.log; return 1; }
    nothing_half new && pull new && same new
}
judge new.during_a_pull new_during
pruned_during() {
    rm -rf pruned
    amid 300000 stop pruned
    sed 's/^\[output\]/&\nprune = "all"/' board.toml >prune.toml
    dicot prune --older-than 1 --config prune.toml
    go_on
    ended
    [ $code = 0 ] || { cat pull.json pull.log; return 1; }
    nothing_half pruned && [ "$(told gone)" -ge 1 ]
}
judge pruned.during_a_pull pruned_during

# --- the computer's disk is full
down && store /vm/store && up || failed full "no board with three snapshots"
mkdir -p disk
mount -t tmpfs -o size=64m tmpfs disk
full() {
    amid 1800000 stop disk/clouds
    cat /dev/zero >disk/greedy 2>/dev/null
    go_on
    ended
    nothing_half disk/clouds || return
    { [ "$code" = 73 ] || [ "$code" = 74 ]; } && grep -i 'space\|full\|room' pull.log &&
        [ "$(find disk/clouds/board/[12]* -name cloud.drc | wc -l)" -ge 1 ] && rm disk/greedy
}
judge full.keeps_what_it_has full
judge full.goes_on eval 'counted_pull disk/clouds && [ "$came" -lt 2600000 ] && same disk/clouds && dicot archive check disk/clouds'
umount disk

# --- one of them dies
puller_dies() {
    rm -rf dies
    amid 1000000 stop dies
    kill -KILL "$puller"
    ended
    [ $code != 0 ] && nothing_half dies && pull dies && same dies
}
judge killed.puller puller_dies
server_dies() {
    rm -rf server
    amid 1000000 stop server
    kill -KILL "$(serving)"
    go_on
    ended
    wait "${board:?}" 2>/dev/null
    nothing_half server || return
    [ "$code" != 0 ] || { echo "the pull says that it is done"; return 1; }
    up && pull server && same server
}
judge killed.server server_dies

# --- a computer that means harm
mtp-files >files.before 2>&1
first_pid=$(serving)
judge hostile.comes_back timeout 200 trial_host hostile 1 40
cp judge.log /out/hostile
# Behind the first time all that it does has been done once: its pages are there, and there are no more of them.
harmless() {
    once_kib=$(memory_kib)
    timeout 200 trial_host hostile 1000 40 || return
    twice_kib=$(memory_kib)
    figure "the server holds $once_kib KiB of its own behind a hostile computer, $twice_kib behind another"
    dicot gadget status --config board.toml
    [ "$first_pid" = "$(serving)" ] && [ "$twice_kib" -le $((once_kib + 16)) ]
}
judge hostile.memory harmless
judge hostile.normal_client eval 'mtp-files >files.after 2>&1; diff files.before files.after && pull harm && same harm'
down
