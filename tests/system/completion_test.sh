#!/bin/sh
# What bash completes and what the manual page lists, against the words in the program's sources.
#
#   completion_test.sh PROGRAM
set -eu
LC_ALL=C
export LC_ALL
program=${1:?completion_test.sh: name the dicot program}
checkout=$(cd "$(dirname "$0")/../.." && pwd)
failed=0

same() { # what, expected, found
    if [ "$2" = "$3" ]; then
        echo "ok      $1"
    else
        echo "FAILED  $1: expected [$(echo "$2" | tr '\n' ' ')], found [$(echo "$3" | tr '\n' ' ')]"
        failed=1
    fi
}

# What bash proposes for the last word, one a line, as after the tabulator.
completed() { # words after "dicot"
    # shellcheck disable=SC2016 # bash's own words
    bash -c '
        . "$0"
        COMP_WORDS=("$@")
        COMP_CWORD=$(($# - 1))
        _dicot "$1" 2>/dev/null
        [ "${#COMPREPLY[@]}" = 0 ] || printf "%s\n" "${COMPREPLY[@]}"
    ' "$checkout/toolchain/package/dicot.bash" "$program" "$@" | sort
}

# First words of calls in the sources, whichever line they stand on.
in_sources() { # pattern of the functions
    find "$checkout/platform/app" -name '*.cpp' -exec cat {} + | tr '\n' ' ' | grep -oE "\\b($1)\\( *\"[^\"]+\"" |
        sed 's/.*"\(.*\)"/\1/' | tr , '\n' | sort -u
}

commands=$(completed '')
parents=$(for command in $commands; do
    ! "$program" "$command" --help | grep -q '^Subcommands:' || echo "$command"
done)
same "commands are those of the sources" "$(in_sources add_subcommand)" "$(
    { echo "$commands"; for command in $parents; do completed "$command" ''; done; } | sort -u)"

each=$(for command in $commands; do
    case " $(echo "$parents" | tr '\n' ' ') " in
        *" $command "*) completed "$command" '' | sed "s/^/$command /" ;;
        *) echo "$command" ;;
    esac
done)
same "options are those of the sources" "$(in_sources 'add|(add|set)_[a-z_]*(option|flag)[a-z_]*' | grep '^-' | grep -vx -e -h)" "$(
    { completed -
    echo "$each" | while read -r command; do
        # shellcheck disable=SC2086 # "rig show" is two words
        completed $command -
    done; } | sort -u | grep -vx -e -h -e --help)"
for command in $(echo "$each" | tr ' ' _); do
    # shellcheck disable=SC2046 # "rig_show" is two words again
    same "options of $command" "$(completed $(echo "$command" | tr _ ' ') -)" \
        "$("$program" $(echo "$command" | tr _ ' ') --help | grep -oE '^  -[^ ]+' | tr -d ' ' | tr , '\n' | sort -u)"
done

same "a beginning is completed" "$(printf 'calibrate\ncapture')" "$(completed ca)"
same "a command of a command" tables "$(completed rig t)"
same "an option's beginning" --near-mm "$(completed process left.png right.png --nea)"
same "choices of an option" "$(printf 'best\nfast\npaper\nstandard')" "$(completed match --method '')"
same "a choice's beginning" neon "$(completed match --method paper --cpu n)"
same "files for an option that names one" "$checkout/LICENSE" "$(completed process --rig "$checkout/LICEN")"
same "files for a plain word" "$checkout/LICENSE" "$(completed info "$checkout/LICEN")"
same "after a flag no value is expected" "$checkout/LICENSE" "$(completed info --json "$checkout/LICEN")"

same "the manual page has every command" "$each" "$(
    sed -n '/^\.SH COMMANDS/,/^\.SH EXAMPLES/p' "$checkout/toolchain/package/dicot.1" | grep '^\.B' |
        tr -d '\134' | grep -oE 'dicot [a-z]+( [a-z-]+)?' | sed 's/^dicot //' | sort)"
exit $failed
