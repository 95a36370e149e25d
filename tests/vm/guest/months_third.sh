# The alarm of the board's clock switched it on: the slot of 12:30 is taken; then all that the months left is told.
#expect off.alarm_woke off.slot_is_done series.each_slot_has_one_row series.as_expected series.verified service.ends_in_order
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
