#!/bin/sh
# clang-tidy 14 with the checks of .clang-tidy. One line a file: "ok" or "FAILED" with what it found.
#
#   sh tests/lint/tidy.sh BUILD_FOLDER [FILE ...]
#
# Without files: the sources of the program but for platform/app, algo/calibration and tests. Those include CLI11,
# nlohmann/json, Eigen and GoogleTest, which take half a minute a file; name them to have them checked.
set -u
cd "$(dirname "$0")/../.." || exit 70
build=${1:?tidy.sh: name a build folder with compile_commands.json, such as .build/clang}
shift
if [ ! -f "$build/compile_commands.json" ]; then
    echo "tidy.sh: $build holds no compile_commands.json; run 'cmake --preset clang' first" >&2
    exit 66
fi
if [ $# = 0 ]; then
    # Vector kernels of another architecture are in no build of this machine.
    for file in $(find platform algo storage drivers \( -path platform/app -o -path algo/calibration \) -prune -o -name '*.cpp' -print | sort); do
        ! grep -qF "/$file\"" "$build/compile_commands.json" || set -- "$@" "$file"
    done
fi
if [ $# = 0 ]; then
    echo "tidy.sh: nothing to check" >&2
    exit 66
fi

# shellcheck disable=SC2016 # expanded by the inner shell
printf '%s\n' "$@" | xargs -P "$(nproc)" -I '{}' sh -c '
    found=$(clang-tidy-14 -p "$1" --quiet "$2" 2>/dev/null)
    code=$?
    if [ $code = 0 ] && [ -z "$found" ]; then
        echo "ok      clang-tidy $2"
    else
        printf "FAILED  clang-tidy %s\n%s\n" "$2" "$(echo "$found" | grep -aE "(warning|error):" | sort -u)"
        exit 1
    fi' tidy "$build" '{}'
