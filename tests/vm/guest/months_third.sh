# The alarm of the board's clock switched it on: the slot of 12:30 is taken; then all that the months left is told, and taken home
# over the cable.
#expect off.alarm_woke off.slot_is_done series.each_slot_has_one_row series.as_expected series.verified service.ends_in_order
#expect cable.shown_by_the_service cable.served_without_rights cable.pulled_by_a_user cable.marked cable.keeps_it_awake
#expect cable.offered_time_is_taken
. /run/vm/months.sh

# It stays on this time.
systemctl mask --runtime --now dicot-power-off.path
judge off.slot_is_done await_slot 300 is_done 12:30
alarm_woke() {
    tr -d ' \n' <"$(record 12:30)" | grep -o '"woken":{[^}]*}' >woken
    cat woken
    grep -q '"by":"alarm"' woken && grep -q '"rest":"off"' woken
}
judge off.alarm_woke alarm_woke
judge service.ends_in_order eval 'systemctl stop dicot && systemctl status --no-pager dicot | grep "status=0/SUCCESS"'

slots >/out/slots
one_row() {
    for hour in 10:10 10:20 10:30 10:40 10:50 11:00 11:10 11:20 11:30 11:40 11:50 12:00 12:10 12:20 12:30; do echo "${day:?}T$hour:00Z"; done >wanted
    printf '1970-01-01T00:40:00Z\n1970-01-01T00:50:00Z\n' >>wanted
    sed -n 's/.*"due": *"\([^"]*\)".*/\1/p' /out/slots | sort >had
    sort wanted | diff - had
}
judge series.each_slot_has_one_row one_row
as_expected() {
    cut -c 1-400 /out/slots
    for hour in 10:10 10:20 10:30 10:50 11:10 11:40 11:50 12:10 12:20 12:30; do is_done $hour || return; done
    [ "$(grep -c '"outcome": *"done"' /out/slots)" = 12 ] && [ "$(grep -c '"outcome": *"missed"' /out/slots)" = 5 ]
}
judge series.as_expected as_expected
judge series.verified dicot verify --store "${clouds:?}"

# --- the cable: a USB device port appears, and at its other end the same machine is a computer (dummy_hcd).
modprobe dummy_hcd
sed -i 's/^between = .*/between = "suspend"/' /etc/dicot/dicot.toml
printf '\n[usb]\nexport = true\n' >>/etc/dicot/dicot.toml
systemctl restart dicot
shown() { dicot gadget status | tee status | grep -q configured; }
judge cable.shown_by_the_service eval 'await 180 shown; cat status; shown'
serves_without_rights() {
    pid=$(dicot gadget status --json | sed -n 's/.*"pid": *\([0-9]*\).*/\1/p')
    [ "$(stat -c %U "/proc/$pid")" = dicot ] && grep 'CapEff:[[:space:]]*0*$' "/proc/$pid/status"
}
judge cable.served_without_rights serves_without_rights
pulled_by_a_user() {
    mkdir -p person && chown nobody person
    HOME=$PWD/person setpriv --reuid nobody --regid plugdev --clear-groups dicot pull person/clouds && dicot archive check person/clouds || return
    diff -r -x ARCHIVE -x BOARD -x LAST_PULL -x incoming person/clouds/board "$clouds/board" >different
    [ -s different ] && cat different && ! grep -vE "^Only in $clouds/board(: (catalogue.sqlite.*|incoming|leaving|quarantine|ballast|writing)|/.*: PULLED)\$" different
}
judge cable.pulled_by_a_user pulled_by_a_user
judge cable.marked eval 'slots | grep -c "\"pulled\": *\"2" | grep -x 17'
sleeps() { cat /sys/power/suspend_stats/success /sys/power/suspend_stats/fail; }
keeps_it_awake() {
    before=$(sleeps)
    sleep 90
    shown && [ "$(sleeps)" = "$before" ]
}
judge cable.keeps_it_awake keeps_it_awake
time_is_taken() {
    date -s '1970-01-01 02:00:00'
    offer_s=$(date -u -d "${day}T18:00:00Z" +%s)
    read -r up_s _ </proc/uptime
    echo "${offer_s}000000 $(echo "$up_s" | tr -d .)0000" >offer
    install -o dicot -g dicot -m 640 offer /run/dicot/offer && mv /run/dicot/offer /run/dicot/clock-offer
    await 60 eval '[ "$(date -u +%F)" = "$day" ]'
}
judge cable.offered_time_is_taken time_is_taken
