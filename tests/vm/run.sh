#!/bin/sh
# Boots the virtual machine with an image of image.sh and judges what it reports.
#
#   sh tests/vm/run.sh IMAGE --timeout SECONDS [--out FOLDER] [--log FILE] [--disk FILE] [--logged-disk FILE] ...
#                      [--own-clock TIME] [--cut WORDS] [--qemu WORDS] ...
#
# --own-clock  the machine's time, RTC and all, is not the world's: it begins at TIME (UTC, 2026-06-01T10:00:00), each instruction
#              takes 8 ns of it, and while the machine has nothing to do it goes on at once to what comes next. So a minute of
#              sleep costs nothing, and how busy the machine is that emulates makes no difference.
# --qemu       words for the emulator, for a device that only one test has.
# --cut        the power is cut as soon as a line "dicot-vm: WORDS" is there; that is then the end the machine has to come to.
#
# FOLDER gets what the script left in /out, FILE the serial console (by default IMAGE.log). The disks are /dev/vdb,
# /dev/vdc and so on in their order; what a logged one was told is written to its FILE.blocks (store/block_log.py). Prints a line "ok" or "FAILED"
# for each test, and behind a failed one what it said last. Exit code 1 when the machine did not come to its end in time
# (the end of the console is then printed), a test failed, an expected one did not report, or the kernel complained.
#
# The machine is emulated, never virtualised: a /dev/kvm that opens is no sign that a kernel boots on it (under some
# hypervisors it does not), and emulation is the same everywhere.
set -u

image=${1:?run.sh: name the image}
shift
timeout_s='' out='' log=$image.log disks='' count=0 clock='' kernel_words='' flush='' end='done' devices=''
while [ $# -gt 1 ]; do
    case $1 in
        --timeout) timeout_s=$2 ;;
        --out) out=$2 ;;
        --log) log=$2 ;;
        --own-clock)
            # Nothing may pass while the disk works: no flush of ours, and a guest that looks up every 4 ms.
            sh "$(dirname "$0")/sleeper.sh" "$image.dtb" || exit
            clock="-icount shift=3,sleep=off -rtc clock=vm,base=$2 -dtb $image.dtb"
            kernel_words='nohz=off' flush=',cache.no-flush=on'
            ;;
        --cut) end=$2 ;;
        --qemu) devices="$devices $2" ;;
        --disk)
            count=$((count + 1))
            disks="$disks -blockdev driver=file,filename=$2,node-name=disk$count$flush
                -device virtio-blk-pci,drive=disk$count,write-cache=on"
            ;;
        --logged-disk)
            count=$((count + 1))
            : >"$2.blocks"
            disks="$disks -blockdev driver=file,filename=$2,node-name=file$count
                -blockdev driver=file,filename=$2.blocks,node-name=log$count
                -blockdev driver=blklogwrites,file=file$count,log=log$count,log-sector-size=512,log-super-update-interval=1,node-name=disk$count
                -device virtio-blk-pci,drive=disk$count,write-cache=on"
            ;;
        *) echo "run.sh: '$1' is no option; see its first lines" >&2; exit 64 ;;
    esac
    shift 2
done
if [ ! -f "$image" ] || [ -z "$timeout_s" ]; then
    echo "run.sh: say an IMAGE that is there, and --timeout SECONDS" >&2
    exit 64
fi
if ! command -v qemu-system-aarch64 >/dev/null; then
    echo "run.sh: qemu-system-aarch64 is missing; install the package qemu-system-arm" >&2
    exit 69
fi
tree=$(sh "$(dirname "$0")/kernel.sh") || exit

failed=0
complain() {
    echo "FAILED  vm $1"
    failed=1
}

disk=$(mktemp)
trap 'rm -f "$disk"' EXIT
truncate -s 256M "$disk"
# shellcheck disable=SC2086 # $disks, $devices and $clock are lists of words; names with blanks or commas are not for it
timeout --foreground --kill-after=5 "$timeout_s" qemu-system-aarch64 -M virt -cpu cortex-a72 -accel tcg -m 512 \
    -nodefaults -display none -nic none -no-reboot -serial stdio -pidfile "$log.pid" $clock \
    -kernel "$tree/vmlinuz" -initrd "$image" \
    -append "console=ttyAMA0 loglevel=3 panic=-1 oops=panic log_buf_len=2M systemd.show_status=0 $kernel_words" \
    -drive "if=none,id=out,file=$disk,format=raw" -device virtio-blk-pci,drive=out $disks $devices \
    </dev/null >"$log.raw" 2>&1 &
machine=$!
while [ "$end" != 'done' ] && kill -0 $machine 2>/dev/null; do
    sleep 0.05
    tr -d '\r' <"$log.raw" | grep -qx "dicot-vm: $end" || continue
    kill -KILL "$(cat "$log.pid")"
    break
done
wait $machine
tr -d '\r' <"$log.raw" >"$log"
rm -f "$log.raw" "$log.pid"

sed -n 's/^dicot-vm: ok \(.*\)/ok      vm \1/p; s/^dicot-vm: figure \(.*\)/        \1/p' "$log"
# Behind each failure what report.sh shows of it, four blanks in.
awk '/^dicot-vm: FAILED / { sub(/^dicot-vm: FAILED/, "FAILED  vm"); print; shown = 1; next }
    !/^    / { shown = 0 }
    shown' "$log"
! grep -q '^dicot-vm: FAILED ' "$log" || failed=1
grep -q "^dicot-vm: $end\$" "$log" || complain "the machine did not come to its end within $timeout_s s"
while read -r name; do
    grep -q -e "^dicot-vm: ok $name\$" -e "^dicot-vm: FAILED $name:" "$log" || complain "$name: did not report"
done <"$image.expect"
complaints=$(grep -aE 'Oops|BUG:|WARNING: CPU|Unable to handle|Kernel panic|blocked for more than' "$log" | head -n 20)
if [ -n "$complaints" ]; then
    complain "the kernel complained"
    echo "$complaints" | sed 's/^/    /'
fi
if [ -n "$out" ] && [ "$end" = 'done' ] && grep -q '^dicot-vm: done$' "$log"; then
    mkdir -p "$out"
    tar -x -m -f "$disk" -C "$out" || complain "what the machine handed out cannot be read"
fi
if ! grep -q "^dicot-vm: $end\$" "$log"; then
    echo "the log ends so ($log):"
    tail -n 40 "$log" | sed 's/^/    /'
fi
exit $failed
