# Runs the story in a whole system, hands out what it left in /out, and switches off: what guest/init does elsewhere.
mkdir -p /run/out /run/work
ln -sfn /run/out /out
cd /run/work || exit
. /run/vm/report.sh
. /run/vm/story
dmesg >/out/dmesg
grep -E 'Oops|BUG:|WARNING: CPU|Unable to handle|Call trace|blocked for more than' /out/dmesg | head -n 20 |
    sed 's/^/dicot-vm: kernel: /'
journalctl -o short-monotonic --no-pager >/out/journal 2>&1
tar -c -C /out . >/dev/vda || failed out "what the story left cannot be handed out"
sync
echo "dicot-vm: done"
[ -f powered_off ] || { echo o >/proc/sysrq-trigger; sleep 60; }
