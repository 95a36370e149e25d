# How a script of the virtual machine reports. To be sourced; the working directory is theirs.

# /out/times tells when each test was done, in seconds since the machine's start.
ok() { # name
    echo "dicot-vm: ok $1"
    read -r up _ </proc/uptime
    echo "$up $1" >>/out/times
}

failed() { # name, why
    echo "dicot-vm: FAILED $1: $2"
}

# Runs a command; its exit code decides. What it printed is shown when it failed.
judge() { # name, command ...
    judged=$1
    shift
    if "$@" >judge.log 2>&1; then
        ok "$judged"
    else
        failed "$judged" "exit code $? of: $*"
        tail -n 12 judge.log | sed 's/^/    /'
    fi
}

# Waits until a command succeeds; at most so many seconds.
await() { # seconds, command ...
    read -r up _ </proc/uptime
    until_s=$((${up%.*} + $1))
    shift
    until "$@" >/dev/null 2>&1; do
        read -r up _ </proc/uptime
        [ "${up%.*}" -lt "$until_s" ] || return 1
        usleep 100000
    done
}
