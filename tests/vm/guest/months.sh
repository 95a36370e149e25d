# What the three stories of the months share: dicot as a service, its slots as `dicot list` tells them. To be sourced by them.
clouds=/var/lib/dicot/clouds
day=$(date -u +%F)
export clouds day
# Programs start slowly under emulation: a look each second is enough, and for a slot first without a program of its own.
usleep() { sleep 1; }
await_slot() { # seconds, is_done or is_missed, hour, words of its reason
    within_s=$1
    shift
    await "$within_s" has_record "$2" && "$@"
}

slots() { dicot list --store "$clouds" --json | grep '"sequence"'; }
# A slot by its hour, as "10:40" of the day, or by day and hour; a line of JSON.
due_of() { case $1 in *T*) echo "$1:00Z" ;; *) echo "${day}T$1:00Z" ;; esac; }
slot() { slots | grep "\"due\": *\"$(due_of "$1")\""; }
has_record() { grep -qrs --include=record.json "\"due\": \"$(due_of "$1")\"" "$clouds"/board/[12]*; }
is_done() { slot "$1" | grep '"outcome": *"done"'; }
is_missed() { # hour, words of its reason
    slot "$1" | grep '"outcome": *"missed"' | grep -E "\"reason\": *\"[^\"]*($2)"
}
record() { # hour: that of a slot that is done
    grep -lr "\"due\": \"${day}T$1:00Z\"" "$clouds/board" --include=record.json | head -n 1
}

process() { systemctl show --value -p MainPID dicot; }
is_up() { [ "$(systemctl is-active dicot)" = active ]; }
restarts() { systemctl show --value -p NRestarts dicot; }

# A slot is at work from the moment at which its folder is there to the one at which it is committed.
at_work() { [ -n "$(ls "$clouds/board/incoming" 2>/dev/null)" ]; }
amid_a_slot() { await 900 at_work && sleep 3 && at_work; }

figure() { echo "dicot-vm: figure $*"; }
