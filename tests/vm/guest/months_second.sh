# The power is back at 11:42: 11:20 was interrupted, 11:30 has passed, 11:40 is only late. Then the clock is lost and found, and
# the board powers itself off.
#expect cut.starts_by_itself cut.row_with_reason cut.passed_slot_has_row cut.late_slot cut.verified
#expect clock.was_right clock.goes_on_in_1970 clock.is_not_trusted clock.set_back clock.passed_slot_has_row off.asked off.alarm_is_set
. /run/vm/months.sh

judge cut.starts_by_itself await 120 is_up
judge cut.row_with_reason await_slot 120 is_missed 11:20 'interrupted|power|stopped'
judge cut.late_slot await_slot 300 is_done 11:40
judge cut.passed_slot_has_row is_missed 11:30 'not running'
judge cut.verified dicot verify --store "${clouds:?}"

judge clock.was_right await_slot 900 is_done 11:50

# --- the clock starts in 1970, and is set again two slots later from the board's own, which went on.
# Linux refuses a time of day that is less than the time since its start, eight minutes here.
date -s '1970-01-01 00:35:00'
goes_on_in_1970() { await_slot 700 is_done 1970-01-01T00:40 && await_slot 700 is_done 1970-01-01T00:50; }
judge clock.goes_on_in_1970 goes_on_in_1970
judge clock.is_not_trusted eval 'slot 1970-01-01T00:40 | grep "not set" && slot 1970-01-01T00:50 | grep "not set"'
judge clock.set_back eval 'hwclock --hctosys --utc && date && await_slot 900 is_done 12:10'
judge clock.passed_slot_has_row is_missed 12:00 'clock'

# --- the board is powered off until 12:30: for ten minutes after a start by hand it stays on, and takes 12:20
sed -i 's/^between = .*/between = "off"/' /etc/dicot/dicot.toml
# systemd ends what runs when it powers off: this goes on until it has seen it. Ten idle minutes, and programs start slowly.
usleep() { sleep 5; }
trap '' TERM
systemctl restart dicot
# The ten minutes in which it stays on are spent asleep by somebody else's wish: awake they would take minutes here too.
rtcwake -u -m freeze -s 520 || failed off.asked "the board cannot be put to sleep"
alarm() { cat /sys/class/rtc/rtc0/wakealarm; }
judge off.asked await 1500 eval '[ "$(systemctl is-system-running)" = stopping ]'
alarm_is_set() {
    alarm_s=$(alarm)
    due_s=$(date -u -d "${day:?}T12:30:00Z" +%s)
    echo "alarm at $alarm_s, slot at $due_s"
    [ "$alarm_s" -lt "$due_s" ] && [ "$alarm_s" -gt $((due_s - 300)) ]
}
judge off.alarm_is_set alarm_is_set
echo "dicot-vm: alarm $(alarm)"
# Not by the story's own end (tell.sh).
touch powered_off
