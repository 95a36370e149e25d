# Completion of dicot's commands, options and choices, for bash. Asked of the program itself (--help): never out of date.

_dicot()
{
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
    local program=$1 help line path=() index
    COMPREPLY=()
    # The commands said so far: each is one that the help of those before it lists.
    help=$("$program" --help 2>/dev/null) || return
    for ((index = 1; index < COMP_CWORD; ++index)); do
        _dicot_listed commands "$help" | grep -qxFe "${COMP_WORDS[index]}" || continue
        path+=("${COMP_WORDS[index]}")
        help=$("$program" "${path[@]}" --help 2>/dev/null) || return
    done

    if [[ $before == -* ]]; then
        # An option that takes one of a few words, or a file, or anything.
        line=$(_dicot_line "$help" "$before")
        if [[ $line =~ \{([a-z0-9,]+)\} ]]; then
            mapfile -t COMPREPLY < <(compgen -W "${BASH_REMATCH[1]//,/ }" -- "$word")
            return
        fi
        if [[ $line =~ ^\ +[^\ ]+\ [A-Z] && ! $line =~ ^\ +[^\ ]+\ (Excludes|Needs): ]]; then
            mapfile -t COMPREPLY < <(compgen -f -- "$word")
            compopt -o filenames 2>/dev/null
            return
        fi
    fi
    if [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_dicot_listed options "$help")" -- "$word")
    elif [[ $help == *$'\nSubcommands:\n'* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_dicot_listed commands "$help")" -- "$word")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
        compopt -o filenames 2>/dev/null
    fi
}

# The names in one part of a help text, one a line.
_dicot_listed() # commands | options, help
{
    if [[ $1 == commands ]]; then
        sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\) .*/\1/p' <<<"$2"
    else
        sed -n '/^Options:/,/^$/s/^  \(-[^ ]*\).*/\1/p' <<<"$2" | tr , '\n'
    fi
}

# The help's line about one option.
_dicot_line() # help, option
{
    sed -n '/^Options:/,/^$/p' <<<"$1" | grep -E -e "^  ([^ ]*,)?$2(,[^ ]*)? " | head -n 1
}

complete -F _dicot dicot
