# The first start of a board: the package is installed, the service enabled, three slots are taken with sleep between them, then
# the program is killed, stopped in its tracks, and the power goes. It begins at 10:00, slots are each ten minutes.
#expect package.installs package.depends package.account package.rights package.stands_still
#expect service.starts service.is_nobody service.listens_to_nothing service.no_network_families service.exposure
#expect sleep.three_slots sleep.alarm_woke sleep.kernel_slept sleep.verified service.journal service.memory_rests
#expect kill.row_with_reason kill.restarted kill.next_slot watchdog.bites watchdog.row_with_reason watchdog.next_slot cut.amid_a_slot
. /run/vm/months.sh

# --- the package
judge package.installs dpkg -i /run/vm/dicot.deb
depends() {
    dpkg-query -W -f '${Status}\n' dicot | grep 'install ok installed'
    dpkg-query -W -f '${Depends}\n' dicot | grep libusb-1.0-0 && [ -z "$(dpkg --audit)" ]
}
judge package.depends depends
account() { id dicot && id -nG dicot | grep -w video && [ "$(id -u dicot)" != 0 ] && ! getent shadow dicot | grep ':\$'; }
judge package.account account
mode() { # file, what it must be
    [ "$(stat -c '%a %U:%G' "$1")" = "$2" ] || { echo "$1 is $(stat -c '%a %U:%G' "$1"), not $2"; return 1; }
}
rights() {
    udevadm settle
    mode /dev/video0 '660 root:video' && mode /dev/video1 '660 root:video' && mode /dev/rtc0 '660 root:dicot' &&
        mode /sys/power/state '664 root:dicot' && mode "${clouds:?}" '750 dicot:dicot'
}
judge package.rights rights
judge package.stands_still eval '! systemctl is-active dicot && [ "$(systemctl is-enabled dicot)" = disabled ]'

# --- the service
cp /run/vm/rig.yaml /run/vm/dicot.toml /etc/dicot/
mkdir -p /etc/systemd/system/dicot.service.d
printf '[Service]\nWatchdogSec=45\n' >/etc/systemd/system/dicot.service.d/soon.conf
starts() {
    dicot schedule --next 3
    systemctl enable --now dicot
    # Type=notify: it is active once the program said that it is ready.
    is_up && systemctl is-enabled dicot && systemctl status --no-pager dicot
    [ "$(systemctl show --value -p StatusText dicot)" != "" ]
}
judge service.starts starts
is_nobody() {
    cat /proc/"$(process)"/status >status || return
    grep -E '^(Uid|Gid|Groups|Cap|NoNew|Seccomp)' status
    [ "$(awk '/^Uid:/ { print $2, $3, $4, $5 }' status | tr ' ' '\n' | sort -u)" = "$(id -u dicot)" ] &&
        grep -E '^CapEff:\s0+$' status && grep -E '^CapBnd:\s0+$' status && grep -E '^NoNewPrivs:\s1$' status &&
        grep -E '^Seccomp:\s2$' status
}
judge service.is_nobody is_nobody
# Of its own sockets only those of the system's log and manager, and the kernel's news; and nothing in its network listens.
listens_to_nothing() {
    pid=$(process)
    [ "$pid" -gt 0 ] || return
    for table in tcp tcp6 udp udp6 udplite raw raw6 packet; do
        [ -f "/proc/$pid/net/$table" ] || continue
        [ "$(tail -n +2 "/proc/$pid/net/$table" | wc -l)" = 0 ] || { cat "/proc/$pid/net/$table"; return 1; }
    done
    for inode in $(find "/proc/$pid/fd" -lname 'socket:*' -printf '%l\n' | tr -dc '0-9\n'); do
        # Of a unix socket the fourth word has bit 16 while it listens.
        awk -v inode="$inode" '$7 == inode && $4 ~ /^00010000$/ { exit 1 }' "/proc/$pid/net/unix" || return
        grep -qw "$inode" "/proc/$pid/net/unix" "/proc/$pid/net/netlink" || { echo "socket $inode is of another kind"; return 1; }
    done
}
judge service.listens_to_nothing listens_to_nothing
# Another program in the same confinement asks for sockets.
no_network_families() {
    sed -E '/^(Type|ExecStart|Restart|RestartSec|WatchdogSec|NotifyAccess|Wants)=/d' /lib/systemd/system/dicot.service >confined
    sed 's,^\[Service\],&\nType=oneshot\nStandardOutput=journal\nExecStart=/usr/bin/perl /run/vm/sockets.pl,' confined \
        >/run/systemd/system/confined.service
    systemctl daemon-reload
    systemctl start confined
    code=$?
    journalctl --no-pager -o cat -u confined
    return $code
}
judge service.no_network_families no_network_families
exposure() {
    systemd-analyze security --no-pager dicot >/out/security
    exposed=$(sed -n 's/.*Overall exposure level for dicot.service: \([0-9.]*\).*/\1/p' /out/security)
    echo "$exposed of 10"
    awk -v exposed="$exposed" 'BEGIN { exit !(exposed != "" && exposed <= 2.0) }'
}
judge service.exposure exposure
figure "exposure by systemd-analyze security: $(cat judge.log)"

# --- three slots; what is seen here of one may be seen only when the board wakes for the next
three_slots() {
    await_slot 1500 is_done 10:10 && first_rss=$(awk '/^VmRSS/ { print $2 }' "/proc/$(process)/status") &&
        await_slot 1500 is_done 10:20 && await_slot 1500 is_done 10:30
}
judge sleep.three_slots three_slots
alarm_woke() {
    for hour in 10:10 10:20 10:30; do
        tr -d ' \n' <"$(record $hour)" | grep -o '"woken":{[^}]*}' >woken
        cat woken
        grep -q '"by":"alarm"' woken && grep -q '"rest":"suspend"' woken || return
        asleep=$(sed 's/.*"asleep_s":\([0-9]*\).*/\1/' woken)
        [ "$asleep" -gt 300 ] || return
    done
}
judge sleep.alarm_woke alarm_woke
judge sleep.kernel_slept eval 'cat /sys/power/suspend_stats/success /sys/power/suspend_stats/fail && [ "$(cat /sys/power/suspend_stats/success)" -ge 3 ]'
read -r up _ </proc/uptime
figure "up for ${up%.*} s, of which awake $(awk '/cpu / { print int(($2 + $3 + $4 + $5 + $6 + $7 + $8) / 100) }' /proc/stat) s"
judge sleep.verified dicot verify --store "${clouds:?}"
has_journal() {
    journalctl --no-pager -u dicot | grep -E '10:30:00Z .*done|done: .*10:30:00Z' &&
        ! journalctl --no-pager -o cat -u dicot -p 3 | grep ' done: ' && ! journalctl --no-pager -o cat -u dicot | grep '^<[0-7]>'
}
judge service.journal has_journal
memory_rests() {
    grep -E '^Vm(RSS|HWM|Lck)' "/proc/$(process)/status"
    now_rss=$(awk '/^VmRSS/ { print $2 }' "/proc/$(process)/status")
    [ "$now_rss" -le $((first_rss + 64)) ]
}
judge service.memory_rests memory_rests
figure "$(tr -s '\n\t ' ' ' <judge.log)"

# --- kill -9 amid 10:40
killed() {
    amid_a_slot && kill -KILL "$(process)" && await_slot 300 is_missed 10:40 'interrupted|stopped|stage'
    slot 10:40
    is_missed 10:40 'interrupted|stopped|stage'
}
judge kill.row_with_reason killed
judge kill.restarted eval 'is_up && [ "$(restarts)" = 1 ]'
judge kill.next_slot await_slot 1500 is_done 10:50

# --- the program stands still amid 11:00
bites() {
    amid_a_slot && stopped=$(process) && kill -STOP "$stopped" && await 200 gone "$stopped"
    journalctl --no-pager -o cat -u dicot | grep -i 'watchdog timeout'
}
gone() { [ ! -d "/proc/$1" ]; }
judge watchdog.bites bites
judge watchdog.row_with_reason await_slot 300 is_missed 11:00 'interrupted|stopped|stage'
judge watchdog.next_slot await_slot 1500 is_done 11:10

# --- the power goes amid 11:20; the next start is to stay awake, to be seen
sed -i 's/^between = .*/between = "idle"/' /etc/dicot/dicot.toml
sync
judge cut.amid_a_slot amid_a_slot
slots >/out/slots
sed 's/^/    /' /out/slots
echo "dicot-vm: the power may go"
sleep 60
