# How a script of the virtual machine reports. To be sourced.

ok() { # name
    echo "dicot-vm: ok $1"
}

failed() { # name, why
    echo "dicot-vm: FAILED $1: $2"
}

# Runs a command; its exit code decides. What it printed is shown when it failed.
judge() { # name, command ...
    judged=$1
    shift
    if "$@" >/tmp/judge.log 2>&1; then
        ok "$judged"
    else
        failed "$judged" "exit code $? of: $*"
        tail -n 12 /tmp/judge.log | sed 's/^/    /'
    fi
}

# Waits until a command succeeds; at most so many seconds.
await() { # seconds, command ...
    until_s=$(($(cut -d. -f1 /proc/uptime) + $1))
    shift
    until "$@" >/dev/null 2>&1; do
        [ "$(cut -d. -f1 /proc/uptime)" -lt "$until_s" ] || return 1
        usleep 100000
    done
}
